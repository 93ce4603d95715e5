"""Files that differ only in a number: found as series, in the order of their numbers, with their gaps."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from tracker.capture.numbered_files import group_by_number, match_pattern, sort_naturally

NUMBERS = st.lists(st.integers(0, 10**6), unique=True, max_size=8)


@given(NUMBERS, st.sampled_from(["{:d}", "{:06d}"]), st.randoms())
def test_a_series_has_all_its_files_in_order_whatever_lies_beside_it(numbers: list[int], digits: str, random) -> None:
    names = [f"a/depth_{digits.format(number)}.PNG" for number in numbers] + ["a/notes.txt", "a/plain.png"]
    random.shuffle(names)
    series = group_by_number(names, (".png",))
    assert [one.pattern for one in series] == ["a/depth_*.PNG"] * bool(numbers)
    for one in series:
        assert one.numbers == tuple(sorted(numbers)) and not one.doubles
        assert one.names == tuple(f"a/depth_{digits.format(number)}.PNG" for number in sorted(numbers))
        assert match_pattern(names, "a/depth_*.PNG") == one


def test_the_last_number_of_a_name_counts_and_the_largest_series_comes_first() -> None:
    names = ["cam1_7_d.png", "cam1_8_d.png", "x/1.jpg", "y/1.jpg", "y/2.jpg", "y/3.jpg"]
    assert [(one.pattern, one.numbers) for one in group_by_number(names, (".png", ".jpg"))] == [
        ("y/*.jpg", (1, 2, 3)),
        ("cam1_*_d.png", (7, 8)),
        ("x/*.jpg", (1,)),
    ]


def test_two_files_of_one_number_are_said() -> None:
    (series,) = group_by_number(["1.png", "01.png", "2.png"], (".png",))
    assert series.numbers == (1, 2) and series.names == ("01.png", "2.png") and series.doubles == ("1.png",)


def test_gaps_are_counted_in_the_usual_step() -> None:
    (series,) = group_by_number([f"{n}.png" for n in (0, 2, 4, 10, 12)], (".png",))
    assert series.step == 2 and series.find_gaps() == [(4, 10, 2)]
    (alone,) = group_by_number(["7.png"], (".png",))
    assert alone.step == 1 and alone.find_gaps() == []


def test_a_pattern_names_its_number_in_every_usual_way_and_nothing_else_in_it_means_anything() -> None:
    names = ["a/x1(.+).png", "a/x22(.+).png", "a/xx.png"]
    for field in ("*", "{:03d}", "{}", "%03d", "%d", "###"):
        series = match_pattern(names, f"a/x{field}(.+).png")
        assert series is not None and series.numbers == (1, 22)
    assert match_pattern(names, "a/x.png") is None and match_pattern(names, "*/*.png") is None


@given(st.lists(st.from_regex(r"[a-c0-9]{1,4}", fullmatch=True), max_size=6))
def test_names_are_sorted_as_people_count(names: list[str]) -> None:
    found = sort_naturally([*names, *(f"cam{n}" for n in (10, 2, 1))])
    assert [name for name in found if name.startswith("cam")] == ["cam1", "cam2", "cam10"]
    assert sort_naturally(reversed(found)) == found or len(set(found)) < len(found) or any(n[0] == "0" for n in names)
