"""An import contract: packages import only what the tables of folders in a page allow."""

from __future__ import annotations

from pathlib import Path

from grimp import ImportGraph
from importlinter import Contract, ContractCheck, fields, output

from lint.folder_table import problems, rows_of
from roomba.commands.pictures.import_graph import folders_in, imports_in


class FolderTableContract(Contract):
    """Checks that the packages agree with the tables of a page.

    Options: ``page``, the path of the page from the folder where the check runs.
    """

    type_name = "folder_table"

    page = fields.StringField()

    def check(self, graph: ImportGraph, verbose: bool) -> ContractCheck:
        """Compare the page with the graph; the contract is kept when they agree."""
        rows = rows_of(Path(str(self.page)).read_text(encoding="utf-8"))
        found = problems(rows, folders_in(graph), imports_in(graph))
        return ContractCheck(kept=not found, metadata={"problems": found})

    def render_broken_contract(self, check: ContractCheck) -> None:
        """Print what differs, a line each, and where to mend it."""
        for problem in check.metadata["problems"]:
            output.print_error(f"- {problem}")
        output.new_line()
        output.print(f"Mend the import, or the tables of {self.page} if the design changes.")
