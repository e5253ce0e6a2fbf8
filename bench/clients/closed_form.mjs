// Two bars between hinges, and a strip that a moment straightens, in closed form: node closed_form.mjs > mine.json
import { readFileSync } from "node:fs";

const read = (name) => JSON.parse(readFileSync(new URL(`../${name}.json`, import.meta.url)));

// A bar of two hinges carries an axial force alone: N = EA (l - L)/L.
function truss(scene, t) {
  const found = {};
  const lift = t * scene.supports.find((one) => one.x === null).y;
  const apex = scene.supports.find((one) => one.x === null).end;
  let held = 0;
  for (const beam of scene.beams) {
    const up = beam.start[1] > beam.end[1];
    const [foot, top] = up ? [beam.end, beam.start] : [beam.start, beam.end];
    const [dx, dy] = [top[0] - foot[0], top[1] + lift - foot[1]];
    const length = Math.hypot(dx, dy);
    const N = (beam.EA * (length - beam.length)) / beam.length;
    const node = `${beam.name}.${up ? "end" : "start"}`;
    Object.assign(found, { [`${node} force_x`]: (-N * dx) / length, [`${node} force_y`]: (-N * dy) / length });
    for (const end of [`${beam.name}.start`, `${beam.name}.end`]) {
      Object.assign(found, { [`${end} displacement_x`]: 0, [`${end} displacement_y`]: end === node ? 0 : lift });
    }
    held += (N * dy) / length;
  }
  return { ...found, [`${apex} force_y`]: held };
}

// A moment alone bends a strip to an arc of the curvature kappa + M/EI.
function arc(scene, t) {
  const [beam, moment] = [scene.beams[0], t * scene.loads[0].moment];
  const turn = (beam.curvature + moment / beam.EI) * beam.length;
  const angle = Math.atan2(beam.direction[1], beam.direction[0]) + turn / 2;
  const chord = beam.length * (turn ? Math.sin(turn / 2) / (turn / 2) : 1);
  const at = [beam.start[0] + chord * Math.cos(angle), beam.start[1] + chord * Math.sin(angle)];
  return {
    [`${beam.name}.start force_x`]: 0,
    [`${beam.name}.start force_y`]: 0,
    [`${beam.name}.start moment`]: -moment,
    [`${beam.name}.end displacement_x`]: at[0] - beam.end[0],
    [`${beam.name}.end displacement_y`]: at[1] - beam.end[1],
  };
}

const known = { "hinged-truss": truss, "straightened-arc": arc };
const { set, queries } = read("queries");
const [found, refused] = [{}, {}];
for (const scene of read("scenes").scenes) {
  if (scene.name in known) found[scene.name] = scene.load_parameters.map((t) => known[scene.name](scene, t));
  else refused[scene.name] = "no closed form here";
}
const answers = queries
  .filter((query) => query.scene in known)
  .map((query) => ({ ...query, value: found[query.scene][query.at][`${query.of} ${query.what}`] }));
console.log(JSON.stringify({ set, program: "closed form", refused, answers }, null, 1));
