"""Hand models as files: the untrained one is there before anybody uses it, and MANO comes for either hand."""

from __future__ import annotations

import uuid
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from server.database import Database
from server.errors import NotFoundError
from server.hand_models.storing import UNTRAINED_ID
from server.registrations.model_files import open_any_model, pack_model, write_mano
from server.storage import Storage
from tests.server.packed_arrays import unpack_arrays
from tracker import BlendModel, load_mano, mirror_blend, untrained_hand


@pytest.fixture(scope="module")
def hand() -> BlendModel:
    return untrained_hand("right")


def test_the_untrained_hand_is_there_though_nobody_has_stored_it(database: Database, tmp_path: Path, hand) -> None:
    storage = Storage(tmp_path / "data")
    with database.reading() as session:
        np.testing.assert_array_equal(open_any_model(session, storage, UNTRAINED_ID).template, hand.template)
        with pytest.raises(NotFoundError, match="There is no hand model"):
            open_any_model(session, storage, uuid.uuid4())


def test_the_browser_gets_the_faces_and_the_side_of_the_model(hand: BlendModel) -> None:
    arrays, facts = unpack_arrays(pack_model(mirror_blend(hand)))
    np.testing.assert_array_equal(arrays["faces"], mirror_blend(hand).faces)
    assert (facts["side"], facts["shape_count"]) == ("left", hand.num_shape)
    assert {name: arrays[name].dtype for name in ("vertices", "faces", "tips")} == {
        "vertices": np.float32,
        "faces": np.uint32,
        "tips": np.uint32,
    }


@pytest.mark.parametrize("own", ["right", "left"])
def test_the_model_of_one_hand_is_written_for_both_and_its_own_is_as_it_is(hand, own: str, tmp_path: Path) -> None:
    model = hand if own == "right" else mirror_blend(hand)
    for side in ("right", "left"):
        path = tmp_path / f"MANO_{side.upper()}.pkl"
        path.write_bytes(write_mano(model, side))
        found = load_mano(path)
        expected = model if side == own else mirror_blend(model)
        np.testing.assert_allclose(found.template, expected.template, atol=1e-12)
        np.testing.assert_array_equal(found.faces, expected.faces)


def test_a_model_with_manos_own_vertices_is_mirrored_as_mano_is(tmp_path: Path, hand: BlendModel) -> None:
    count = 778
    own = replace(
        hand,
        template=hand.template[:count],
        faces=hand.faces[(hand.faces < count).all(axis=1)],
        shape_directions=hand.shape_directions[:count],
        pose_directions=hand.pose_directions[:count],
        skinning_weights=hand.skinning_weights[:count],
        joint_regressor=hand.joint_regressor[:, :count],
        tips=np.minimum(hand.tips, count - 1),
    )
    path = tmp_path / "MANO_LEFT.pkl"
    path.write_bytes(write_mano(own, "left"))
    np.testing.assert_allclose(load_mano(path).template, own.template * [-1.0, 1.0, 1.0], atol=1e-12)
