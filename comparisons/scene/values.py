"""Values as TOML writes them."""


def toml_value(value: object) -> str:
    """Return `value` as TOML writes it in one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        return '"' + "".join(c if c.isprintable() else f"\\U{ord(c):08x}" for c in escaped) + '"'
    if isinstance(value, list | tuple):
        return "[" + ", ".join(toml_value(item) for item in value) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{item} = {toml_value(inner)}" for item, inner in value.items()) + "}"
    return repr(value) if isinstance(value, int | float) else str(value)
