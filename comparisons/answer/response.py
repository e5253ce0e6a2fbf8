"""The response of a model to a scene: an answer that prints itself."""

from typing import Any

from numpy.typing import NDArray

from comparisons.answer.record import Answer


class Response(Answer):
    """The response of one model to one scene, the record that all models return.

    It prints itself in a line, and in a notebook as the page that ``crossval solve`` prints.
    """

    def __repr__(self) -> str:
        reached = len(self.load_parameter)
        last = f", the last {self.load_parameter[-1]:g}" if reached else ""
        return f"<Response {self.scene} by {self.named}: {self.status}, {reached} load parameters{last}>"

    def _repr_html_(self) -> str:
        from comparisons.answer.page import html

        return html(self)

    def page(self) -> str:
        """Return the page that ``crossval solve`` prints: status, reactions, contacts, extremes and events."""
        from comparisons.answer.page import text

        return text(self)

    def table(self) -> dict[str, NDArray[Any]]:
        """Return the histories by name, each of shape (s,): what ``pandas.DataFrame`` takes. See `comparisons.answer.table`."""
        from comparisons.answer.table import table

        return table(self)
