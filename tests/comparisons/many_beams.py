"""Scenes of any number of beams, for what their number costs."""

HEAD = '[scene]\nname = "many"\nload_parameters = 3\n'
SECTION = "youngs_modulus = 2.1e11\npoissons_ratio = 0.3\nwidth = 0.02\nheight = 0.02\nelements = 2\n"
LOAD = '[[load]]\nbeam = "{}"\nend = "end"\nforce = [0.0, -100.0]\n'


def _beam(name: str, start: tuple[int, int], end: tuple[int, int], more: str = "") -> str:
    return f'[[beam]]\nname = "{name}"\nstart = {list(start)}\nend = {list(end)}\n{SECTION}{more}\n'


def chain(number: int) -> str:
    """Beams in a row, clamped at one end, with a force at the other that lifts it by a fifth of the length.

    They are thick: of a chain 100,000 times as long as it is high, positions in double precision do not resolve the forces.
    """
    beams = [_beam("b0", (0, 0), (1, 0), 'clamped = ["start"]')]
    beams += [_beam(f"b{i}", (i, 0), (i + 1, 0)) for i in range(1, number)]
    EI = 2.1e11 * 0.5**4 / 12
    force = f"force = [0.0, {0.6 * EI / number**2!r}]"
    text = HEAD + "".join(beams) + LOAD.format(f"b{number - 1}").replace("force = [0.0, -100.0]", force)
    return text.replace("= 0.02", "= 0.5")


def spans(number: int) -> str:
    """A continuous beam over supports, loaded between them."""
    beams = [_beam(f"b{i}", (i, 0), (i + 1, 0)) for i in range(number)]
    feet = ['[[support]]\nbeam = "b0"\nend = "start"\nkind = "pinned"\n']
    feet += [
        f'[[support]]\nbeam = "b{i}"\nend = "end"\nkind = "roller"\nfree = "x"\n' for i in range(1, number, 2)
    ]
    return HEAD + "".join([*beams, *feet, *(LOAD.format(f"b{i}") for i in range(0, number, 2))])


def field(number: int) -> str:
    """Cantilevers that have nothing to do with one another, each loaded at its tip."""
    wide = round(number**0.5)
    corners = [(2 * (i % wide), 2 * (i // wide)) for i in range(number)]
    beams = [_beam(f"b{i}", (x, y), (x + 1, y), 'clamped = ["start"]') for i, (x, y) in enumerate(corners)]
    return HEAD + "".join([*beams, *(LOAD.format(f"b{i}") for i in range(number))])


def frame(number: int) -> str:
    """Storeys of columns and girders, pushed from the side."""
    wide = max(round((number / 2) ** 0.5), 2)
    parts = []
    for j in range(wide):
        foot = 'clamped = ["start"]' if j == 0 else ""
        parts += [_beam(f"c{i}-{j}", (i, j), (i, j + 1), foot) for i in range(wide)]
        parts += [_beam(f"g{i}-{j}", (i, j + 1), (i + 1, j + 1)) for i in range(wide - 1)]
    return HEAD + "".join(parts) + LOAD.format(f"c0-{wide - 1}")


MANY = {"chain": chain, "spans": spans, "field": field, "frame": frame}
