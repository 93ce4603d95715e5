"""Which layers of a scene are shown, and in which colours."""

from __future__ import annotations

import numpy as np
import pytest

from server.viewer.layers import (
    FINGER_COLORS,
    LAYER_NAMES,
    VIEW_ATTRIBUTES,
    WRIST_COLOR,
    Layers,
    hand_colors,
    repeat,
    term_color,
)
from tracker import HAND_JOINTS
from tracker.inspection import find_term_look


def test_a_scene_begins_with_the_points_and_the_meshes() -> None:
    shown = {name for name in LAYER_NAMES if getattr(Layers(), name)}
    assert shown == {"cloud", "mesh", "dark"}


def test_layers_change_one_by_one_and_the_old_ones_stay_as_they_were() -> None:
    before = Layers()
    after = before.with_changes({"cloud": False, "skeleton": True})
    assert (after.cloud, after.mesh, after.skeleton) == (False, True, True)
    assert (before.cloud, before.skeleton) == (True, False)


def test_what_is_no_layer_changes_nothing() -> None:
    assert Layers().with_changes({"hidden_terms": ["physics"], "with_changes": True, "sky": True}) == Layers()


def test_terms_are_hidden_by_name_and_the_others_stay() -> None:
    layers = Layers().with_changes({"correspondences": {"model_to_data": True, "physics": False}})
    assert layers.correspondences and layers.shows_term("model_to_data") and not layers.shows_term("physics")
    again = layers.with_changes({"correspondences": {"physics": True, "collision": False}})
    assert again.shows_term("physics") and not again.shows_term("collision") and again.shows_term("model_to_data")


def test_no_term_is_shown_while_the_correspondences_are_off() -> None:
    hidden = Layers().with_changes({"correspondences": {"physics": False}}).with_changes({"correspondences": False})
    assert not hidden.shows_term("model_to_data")
    back = hidden.with_changes({"correspondences": True})
    assert back.shows_term("model_to_data") and not back.shows_term("physics"), "what was hidden stays hidden"


@pytest.mark.parametrize("name", ["detections", "collisions", "contacts"])
def test_meshes_let_more_through_when_something_lies_in_them(name: str) -> None:
    assert not Layers().is_inside_shown
    assert Layers().with_changes({name: True}).is_inside_shown


def test_a_frame_works_out_what_is_shown_and_nothing_else() -> None:
    class View:
        """Notes what was asked for."""

        def __init__(self) -> None:
            self.asked: set[str] = set()

        def __getattr__(self, name: str) -> None:
            self.asked.add(name)

    for changes in ({}, {"cloud": False}, {"distances": True, "cameras": True}, dict.fromkeys(LAYER_NAMES, True)):
        view, layers = View(), Layers().with_changes(changes)
        layers.prepare(view)  # pyright: ignore[reportArgumentType]
        assert view.asked == {what for name, what in VIEW_ATTRIBUTES.items() if getattr(layers, name)}


def test_each_finger_has_its_colour_and_the_wrist_none() -> None:
    colors = hand_colors()
    assert colors.shape == (21, 3) and colors.dtype == np.uint8
    for joint, color in zip(HAND_JOINTS, colors.tolist(), strict=True):
        assert tuple(color) == FINGER_COLORS.get(joint.split("_")[0], WRIST_COLOR)
    assert len({tuple(color) for color in colors.tolist()}) == 6


def test_a_term_has_the_colour_of_its_look_on_either_ground() -> None:
    look = find_term_look("model_to_data")
    assert "#" + bytes(term_color("model_to_data")).hex() == look.color.lower()
    assert "#" + bytes(term_color("model_to_data", dark=False)).hex() == look.color_on_white.lower()
    assert term_color("of tomorrow") == term_color("of tomorrow")


def test_one_colour_for_many_points() -> None:
    assert repeat((1, 2, 3), 2).tolist() == [[1, 2, 3], [1, 2, 3]] and repeat((1, 2, 3), 0).shape == (0, 3)
