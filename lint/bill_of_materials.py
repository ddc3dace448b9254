"""``./roomba sbom``: a bill of materials of the running robot, as CycloneDX in JSON.

With ``--audit`` the packages of PyPI are looked up among known vulnerabilities, too.
"""

from __future__ import annotations

import argparse
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from cyclonedx.model.bom import Bom
from cyclonedx.model.component import Component, ComponentType
from cyclonedx.model.license import DisjunctiveLicense
from cyclonedx.output import make_outputter
from cyclonedx.schema import OutputFormat, SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator
from packageurl import PackageURL

from lint.advisories import audit
from lint.materials import Material, python_materials, system_materials
from roomba.commands.process_end import quiet_end

_SCHEMA: Final = SchemaVersion.V1_6


def bill(project: Path, materials: Sequence[Material]) -> str:
    """Return the bill as text; raises ValueError when it is not as the standard wants it."""
    package = ElementTree.parse(project / "package.xml").getroot()
    name, version = (package.findtext(part, "") for part in ("name", "version"))
    robot = Component(
        name=name, version=version, type=ComponentType.APPLICATION, bom_ref=f"{name}@{version}"
    )
    bom = Bom()
    bom.metadata.component = robot
    components = {(each.source, each.name): _component(each) for each in materials}
    bom.components.update(components.values())
    bom.register_dependency(robot, components.values())
    for each in materials:
        bom.register_dependency(
            components[each.source, each.name],
            [components[each.source, need] for need in each.needs],
        )
    text = str(make_outputter(bom, OutputFormat.JSON, _SCHEMA).output_as_string(indent=2))
    fault = JsonStrictValidator(_SCHEMA).validate_str(text)
    if fault is not None:
        raise ValueError(f"expected a bill as CycloneDX {_SCHEMA.to_version()} has it: {fault}")
    return text


def _component(material: Material) -> Component:
    namespace = "debian" if material.source == "deb" else None
    address = PackageURL(material.source, namespace, material.name, material.version)
    return Component(
        name=material.name,
        version=material.version,
        type=ComponentType.LIBRARY,
        purl=address,
        bom_ref=address.to_string(),
        licenses=[DisjunctiveLicense(name=material.license)] if material.license else [],
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the bill; return 1 when the audit found something, 2 if no file can be made."""
    parser = argparse.ArgumentParser(prog="./roomba sbom", description=__doc__)
    parser.add_argument("--out", type=Path, help="a file; without it standard output")
    parser.add_argument("--audit", action="store_true", help="look for known vulnerabilities")
    parser.add_argument("--site-packages", type=Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--system-package", action="append", default=[], help=argparse.SUPPRESS)
    given = parser.parse_args(arguments)
    project = Path(__file__).resolve().parents[1]
    python = python_materials(given.site_packages, project / "requirements.txt")
    materials = [*system_materials(given.system_package), *python]
    text = bill(project, materials)
    if given.out is None:
        print(text)
    else:
        try:
            given.out.write_text(f"{text}\n", encoding="utf-8")
        except OSError as error:
            print(f"./roomba sbom: {error}; choose another file", file=sys.stderr)
            return 2
        print(f"{given.out}: {len(materials)} packages", file=sys.stderr)
    return audit(materials) if given.audit else 0


if __name__ == "__main__":
    with quiet_end():
        sys.exit(main())
