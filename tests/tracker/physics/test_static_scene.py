"""Which way things fall: as the recording says, else as a table tells, else along the camera's +y."""

import numpy as np

from tracker.geometry import se3
from tracker.physics import StaticPlane, StaticScene, choose_down

CAMERA = se3.exp(np.array([0.1, 0.2, 0.3, 0.2, 0.0, 0.0]))
TILTED = np.array([0.0, -0.9, -0.4]) / np.linalg.norm([0.0, -0.9, -0.4])
TABLE = StaticPlane((0.0, 0.2, 0.6), (0.0, float(TILTED[1]), float(TILTED[2])))
WALL = StaticPlane((0.0, 0.0, 1.0), (0.0, 0.0, -1.0))


def test_the_recording_comes_first_then_a_level_plane_then_the_camera():
    assert choose_down((1.0, 0.0, 0.0), (TABLE,), CAMERA) == ((1.0, 0.0, 0.0), "recording")
    down, source = choose_down(None, (WALL, TABLE), np.eye(4))
    np.testing.assert_allclose(down, -np.array(TABLE.normal))
    assert source == "plane"
    down, source = choose_down(None, (WALL,), CAMERA)
    np.testing.assert_allclose(down, CAMERA[:3, 1])
    assert source == "camera"


def test_it_is_kept_in_json_as_it_is():
    scene = StaticScene((0.0, 0.6, 0.8), "recording", (TABLE, WALL), "depth")
    assert StaticScene.from_json(scene.to_json()) == scene
