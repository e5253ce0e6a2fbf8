"""The league: every program at several of its own resolutions on every scene that it can state, against the exact rods."""
