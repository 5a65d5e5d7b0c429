"""The loader: limits, places, and --set."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from mdlgen.errors import OutputError, SpecError
from mdlgen.paths import samples
from mdlgen.spec.load import MAX_BYTES, MAX_DEPTH, load, loads

CANTILEVER = (samples() / "cantilever.yaml").read_text("utf-8")


def refused(text: str, *overrides: str) -> SpecError:
    with pytest.raises(SpecError) as raised:
        loads(text, "scene.yaml", overrides)
    assert raised.value.exit_code == 2
    assert raised.value.place is not None
    assert "\n" not in str(raised.value)
    return raised.value


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("a: &x 1\nb: *x\n", 1, "anchors"),
        ("a: 1\nb: !!python/object:os.system x\n", 2, "tags"),
        ("a: 1\nb: 2\na: 3\n", 3, "'a' stands twice, first in line 1; write one key with all of it"),
        ("a: 1\n---\nb: 1\n", 2, "second document"),
        ("a: [1, 2\nb: }\n", 2, "not YAML"),
        ("? [1, 2]\n: 3\n", 1, "plain name"),
        ("- 1\n- 2\n", 1, "mapping"),
        ("just words\n", 1, "mapping"),
        ("", 1, "mapping"),
        ("a: 1e400\n", 1, "not finite"),
        ("<<: {a: 1}\n", 1, "unknown key"),
        ("a: \x00\n", 1, "not YAML"),
    ],
)
def test_limits_of_the_text(text: str, line: int, words: str) -> None:
    error = refused(text)
    assert words in error.message
    assert error.place is not None and error.place.line == line


def test_depth() -> None:
    assert "deeper" in refused("a: " + "[" * (MAX_DEPTH + 1) + "]" * (MAX_DEPTH + 1)).message


def test_deep_nesting_does_not_exhaust_the_stack() -> None:
    refused("[" * 100_000)
    refused("{a: " * 20_000)


def test_size(tmp_path: Path) -> None:
    path = tmp_path / "big.yaml"
    path.write_bytes(b"#" * (MAX_BYTES + 1))
    with pytest.raises(SpecError, match="larger than"):
        load(path)


def test_not_utf8_tells_the_line(tmp_path: Path) -> None:
    path = tmp_path / "latin.yaml"
    path.write_bytes(b"name: x\n# caf\xe9\n")
    with pytest.raises(SpecError, match="UTF-8") as raised:
        load(path)
    assert raised.value.place is not None and raised.value.place.line == 2


def test_missing_file_is_an_output_error(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="cannot read"):
        load(tmp_path / "none.yaml")


def test_json_is_read_too() -> None:
    import json

    scene = {
        "name": "block",
        "materials": {"m": {"E_md": "1 GPa", "E_cd": "1 GPa", "k_tx": "1 N*mm/rad", "k_ty": "1 N*mm/rad"}},
        "sheets": {
            "b": {
                "material": "m",
                "size": ["1 mm", "1 mm"],
                "thickness": "1 mm",
                "mass": "1 g",
                "boxes": [1, 1],
            }
        },
    }
    assert loads(json.dumps(scene, indent=1)).sheets["b"].boxes == (1, 1)


class TestSet:
    def test_value_with_a_unit(self) -> None:
        assert loads(CANTILEVER, "s", ["sheets.note.thickness=0.2 mm"]).sheets["note"].thickness == 0.2

    def test_list(self) -> None:
        assert loads(CANTILEVER, "s", ["sheets.note.boxes=[4,8]"]).sheets["note"].boxes == (4, 8)

    def test_missing_intermediate_keys_are_made(self) -> None:
        scene = loads(CANTILEVER, "s", ["probes.mid.sheet=note", "probes.mid.at=[0 mm, 0 mm]"])
        assert scene.probes["mid"].at == (0.0, 0.0)

    def test_alternatives_replace_each_other(self) -> None:
        material = loads(CANTILEVER, "s", ["materials.eur10.k_tx=0.2 N*mm/rad"]).materials["eur10"]
        assert (material.k_tx, material.D_cd) == (0.2, None)
        assert material.D_md is not None
        sheet = loads(CANTILEVER, "s", ["sheets.note.turn=1 deg", "sheets.note.rotation=[0 deg,0 deg,2 deg]"])
        assert sheet.sheets["note"].turn is None

    def test_index_in_a_list(self) -> None:
        text = (samples() / "verify" / "drop.yaml").read_text("utf-8")
        assert loads(text, "s", ["contacts.0.restitution=0.9"]).contacts[0].restitution == 0.9

    def test_a_text_in_place_of_a_list_is_answered(self) -> None:
        with pytest.raises(SpecError, match=r"write \['run.tolerance=1e-2'\]"):
            loads(CANTILEVER, "s", "run.tolerance=1e-2")

    def test_last_one_wins(self) -> None:
        scene = loads(CANTILEVER, "s", ["run.tolerance=1e-2", "run.tolerance=1e-4"])
        assert scene.run.tolerance == 1e-4

    @pytest.mark.parametrize(
        ("override", "words"),
        [
            ("sheets.note.thickness", "PATH=VALUE"),
            ("=1", "PATH=VALUE"),
            ("sheets..note=1", "PATH=VALUE"),
            ("sheets.note.thicknes=1 mm", "did you mean 'thickness'"),
            ("sheets.note.thickness=1", "no unit"),
            ("sheets.note.thickness=1 g", "wrong unit"),
            ("sheets.note.size.7=1 mm", "no item"),
            ("name.x=1", "plain value"),
            ("sheets.note.boxes=[1", "not YAML"),
            ("sheets.note.boxes=*x", "anchors"),
        ],
    )
    def test_errors_name_the_option(self, override: str, words: str) -> None:
        error = refused(CANTILEVER, override)
        assert words in error.message
        assert error.place is not None and error.place.file.startswith("--set ")

    def test_a_pattern_meets_every_name_that_fits(self) -> None:
        text = (samples() / "transport_4x4.yaml").read_text("utf-8")
        scene = loads(text, "s", ["rollers.motor_*.radius=8 mm", "contacts.*.restitution=0.1"])
        assert {name: r.radius for name, r in scene.rollers.items() if r.radius != 5.0} == {
            f"motor_{row}_{side}": 8.0 for row in (1, 2) for side in ("left", "right")
        }
        assert {c.restitution for c in scene.contacts} == {0.1}

    @pytest.mark.parametrize(
        ("override", "text"),
        [
            (
                "sheets.nota.boxes=[4,8]",
                "there is no 'nota' in sheets; did you mean 'note'? there are: note; "
                "a new one needs material, size, thickness, mass",
            ),
            (
                "rollers.motor.drive.speed=1 rad/s",
                "there is no 'motor' in rollers; there are: none; a new one",
            ),
            ("sheets.x*.boxes=[4,8]", "nothing here fits 'x*'; there are: note"),
        ],
    )
    def test_a_part_that_is_not_there(self, override: str, text: str) -> None:
        error = refused(CANTILEVER, override)
        assert error.message.startswith(text) and error.others == ()
        assert error.place is not None and error.place.file == f"--set {override.partition('=')[0]}"


class TestAllAtOnce:
    def test_sorted_by_place_and_each_with_its_line(self) -> None:
        text = (
            CANTILEVER.replace("thickness: 0.1 mm", "thickness: 0.1", 1)
            .replace("E_md: 3530 MPa", "E_md: 3530 mm", 1)
            .replace("sheet: note", "sheet: nota", 1)
        )
        first = refused(text)
        found = [first, *first.others]
        assert [".".join(map(str, e.path)) for e in found] == [
            "materials.eur10.E_md",
            "sheets.note.thickness",
            "probes.tip.sheet",
        ]
        for error in found:
            assert error.place is not None
            line = text.splitlines()[error.place.line - 1]
            assert error.source == line
            shown, caret = error.marked.splitlines()
            assert shown == f"    {line}" and caret.index("^") == 3 + error.place.column
        assert first.__notes__ == [str(e) for e in first.others]

    def test_at_most_twenty(self) -> None:
        keys = "".join(f"key_{k}: 1\n" for k in range(30))
        first = refused(CANTILEVER + keys)
        assert [e.path for e in (first, *first.others[:-1])] == [(f"key_{k}",) for k in range(20)]
        assert str(first.others[-1]) == "10 more errors; correct these first"

    def test_one_mistake_is_reported_once(self) -> None:
        for old, new in (("thickness:", "thicknes:"), ("  note:", "  notes:"), ("boxes: [", "boxes: [1, ")):
            assert refused(CANTILEVER.replace(old, new, 1)).others == (), new

    def test_a_missing_key_says_how_it_is_written(self) -> None:
        text = CANTILEVER.replace("thickness: 0.1 mm", "", 1)
        assert "the key 'thickness' is missing; write like thickness: 1 mm" in refused(text).message

    def test_a_wrong_item_of_a_list_says_how_the_list_is_written(self) -> None:
        error = refused(re.sub(r"boxes: \[\d+", "boxes: [2.5", CANTILEVER, count=1))
        assert error.message.endswith("got 2.5; write like boxes: [10, 10]")

    def test_a_comma_between_two_values_is_answered(self) -> None:
        text = (samples() / "verify" / "drop.yaml").read_text("utf-8")
        assert "restitution: 0.7" in text
        error = refused(text.replace("restitution: 0.7", "restitution: 0,5"))
        assert error.message.startswith("unknown key '5': a comma ends the value before it")
        assert error.others == ()

    def test_set_comes_first(self) -> None:
        text = CANTILEVER.replace("thickness: 0.1 mm", "thickness: 0.1", 1)
        first = refused(text, "run.tolerance=x", "name.x=1")
        assert [e.place.file for e in (first, *first.others) if e.place] == [
            "--set name.x",  # it cannot be set at all
            "--set run.tolerance",
            "scene.yaml",
        ]


def test_every_sample_loads() -> None:
    found = sorted(samples().rglob("*.yaml"))
    assert len(found) >= 7
    for path in found:
        assert load(path).name == path.stem


def test_a_mapping_where_a_list_is_due_says_how_items_begin() -> None:
    message = refused(f"{CANTILEVER}\nloads:\n  pull: {{sheet: note, edge: y_max, force: [0 N, 1 N, 0 N]}}\n")
    assert "loads: expected a list, each item begun with '- ', got {'pull'" in str(message)
