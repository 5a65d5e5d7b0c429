"""What a user writes: a scene without a file, changed, checked, run and looked at."""

from pathlib import Path

import mdlgen


def rollers(radius: float, speed: float) -> dict[str, mdlgen.Roller]:
    """A driven roller below a sheet, and one that is pressed onto it."""
    low, high = f"{-radius - 0.04} mm", f"{radius + 0.05} mm"
    motor = mdlgen.Roller(
        center=["0 mm", "0 mm", low],
        axis="y",
        diameter=f"{2 * radius} mm",
        width="8 mm",
        mass="3 g",
        drive=mdlgen.Drive(speed=f"{speed} rad/s", ramp="2 ms"),
    )
    idler = mdlgen.Roller(
        center=["0 mm", "0 mm", high],
        axis="y",
        radius=f"{radius} mm",
        width="8 mm",
        mass="1 g",
        press=mdlgen.Press(direction="-z", stiffness="0.3 N/mm", preload="3 N"),
    )
    return {"motor": motor, "idler": idler}


def ticket() -> mdlgen.Scene:
    paper = mdlgen.Material(E_md="3.5 GPa", E_cd="1.1 GPa", D_md="0.2 N*mm", D_cd="0.1 N*mm")
    note = mdlgen.Sheet(
        material="paper", size=["60 mm", "20 mm"], thickness="0.1 mm", grammage="80 g/m^2", boxes=[12, 1]
    )
    return mdlgen.Scene(
        name="ticket",
        materials={"paper": paper},
        sheets={"note": note},
        rollers=rollers(7.5, 60.0),
        contacts=[
            mdlgen.Contact(between=["note", ["motor", "idler"]], stiffness="300 N/mm^1.5", friction=0.8),
            mdlgen.Contact(between=["motor", "idler"], stiffness="30 N/mm^1.5", friction=0.5),
        ],
        run=mdlgen.Run(duration="10 ms", tolerance=0.01),
        probes={"lead": {"sheet": "note", "edge": "x_max"}},
    )


def main(folder: Path) -> list[float]:
    scene = ticket().with_({"rollers.motor.drive.speed": "80 rad/s"})
    findings: list[str] = [lint.code for lint in scene.check()]
    result: mdlgen.Result = mdlgen.solve(mdlgen.lower(scene))
    sheet, motor = result.sheets["note"], result.rollers["motor"]
    print(findings, sheet.travel[0], sheet.units["travel"], motor.speed, result.probes["lead"].displacement)
    result.report(folder / "report.html")
    result.plot("speed").save(folder / "speed.png")
    found = scene.sweep({"contacts.0.friction": [0.4, 0.8]}, ["sheets.note.travel_mm.x"])
    (folder / "scene.yaml").write_text(scene.to_yaml())
    return [row.measures["sheets.note.travel_mm.x"] or 0.0 for row in found]


if __name__ == "__main__":
    print(main(Path()))
