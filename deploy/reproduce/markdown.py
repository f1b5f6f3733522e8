"""A result as Markdown: the table of theirs beside ours. docs/worked-examples.md is made of these."""

from __future__ import annotations

from collections.abc import Iterable

from deploy.reproduce.kinds import Reproduction, Result


def page(reproduction: Reproduction, result: Result, pictures: Iterable[str] = ()) -> str:
    """One section; `pictures` are shown below its table."""
    rows = [
        "| " + " | ".join(_cell(text) for text in (row.quantity, row.thesis, row.ours, row.verdict, row.note)) + " |"
        for row in result.rows
    ]
    head = f"## `{reproduction.name}`: {reproduction.title}\n\n{reproduction.place}\n"
    table = "\n".join(["| quantity | the thesis | we | verdict | |", "|---|---|---|---|---|", *rows])
    shown = "".join(f"\n![{reproduction.name}]({picture})" for picture in pictures)
    return f"{head}\n{table}\n{shown}\n" if shown else f"{head}\n{table}\n"


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")
