"""The command line, from the parser that reads it."""

import argparse

from comparisons.cli.command import command_parser
from docs.extensions.markdown import table, text


def page() -> str:
    """Return one section for every command: its usage, its arguments, its exit statuses."""
    commands = next(
        action.choices
        for action in command_parser()._actions  # noqa: SLF001 - argparse has no public way to ask
        if isinstance(action, argparse._SubParsersAction)  # noqa: SLF001
    )
    helps = _helps()
    return "\n\n".join(_section(name, command, helps[name]) for name, command in commands.items()) + "\n"


def _helps() -> dict[str, str]:
    action = next(a for a in command_parser()._actions if isinstance(a, argparse._SubParsersAction))  # noqa: SLF001
    return {item.dest: item.help or "" for item in action._choices_actions}  # noqa: SLF001


def _section(name: str, command: argparse.ArgumentParser, about: str) -> str:
    usage = " ".join(command.format_usage().split()).removeprefix("usage: ")
    rows = [
        (f"`{_form(action)}`", text(action.help or ""))
        for action in command._actions  # noqa: SLF001
        if not isinstance(action, argparse._HelpAction)  # noqa: SLF001
    ]
    parts = [f"## `crossval {name}`", text(_sentence(about)), f"```text\n{usage}\n```"]
    if command.description:
        parts.append(text(_sentence(command.description)))
    if rows:
        parts.append(table(("argument", "meaning"), rows))
    if command.epilog:
        parts.append(text(_sentence(command.epilog)))
    return "\n\n".join(parts)


def _form(action: argparse.Action) -> str:
    value = action.metavar or (
        "{" + ",".join(map(str, action.choices)) + "}" if action.choices else action.dest
    )
    if not action.option_strings:
        return str(value)
    return ", ".join(action.option_strings) + ("" if action.nargs == 0 else f" {value}")


def _sentence(words: str) -> str:
    return words[:1].upper() + words[1:].rstrip(".") + "."
