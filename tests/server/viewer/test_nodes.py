"""The nodes of a scene are made once, changed afterwards, and hidden when a frame has none of them."""

from __future__ import annotations

import socket
from collections.abc import Iterator

import numpy as np
import pytest
import viser

from server.viewer.nodes import LIFT, SceneNodes

RED = np.array([[255, 0, 0]], dtype=np.uint8)
TRIANGLE = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]], dtype=np.float32)


@pytest.fixture(scope="module")
def server() -> Iterator[viser.ViserServer]:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    server = viser.ViserServer("127.0.0.1", port, verbose=False)
    yield server
    server.stop()


@pytest.fixture
def nodes(server: viser.ViserServer) -> SceneNodes:
    server.scene.reset()
    return SceneNodes(server)


def test_a_node_of_the_next_frame_is_the_same_with_other_points(nodes: SceneNodes) -> None:
    nodes.begin()
    nodes.points("/cloud", np.zeros((1, 3)), RED, 0.001)
    nodes.end()
    made = nodes._handles["/cloud"]
    nodes.begin()
    nodes.points("/cloud", np.ones((2, 3)), np.repeat(RED, 2, axis=0), 0.001)
    nodes.end()
    assert nodes._handles == {"/cloud": made}
    assert made.visible and np.array_equal(made.points, np.ones((2, 3)))


def test_what_a_frame_does_not_have_is_hidden_until_one_has_it_again(nodes: SceneNodes) -> None:
    def draw(*names: str) -> dict[str, bool]:
        nodes.begin()
        for name in names:
            nodes.points(name, np.zeros((1, 3)), RED, 0.001)
        nodes.end()
        return {name: handle.visible for name, handle in nodes._handles.items()}

    assert draw("/a", "/b") == {"/a": True, "/b": True}
    assert draw("/b") == {"/a": False, "/b": True}
    assert draw("/a") == {"/a": True, "/b": False}
    assert draw() == {"/a": False, "/b": False}


def test_both_ends_of_a_segment_have_its_colour(nodes: SceneNodes) -> None:
    nodes.begin()
    nodes.segments("/lines", np.arange(6.0).reshape(1, 2, 3), RED, 2.0)
    handle = nodes._handles["/lines"]
    assert np.array_equal(handle.points, np.arange(6.0).reshape(1, 2, 3))
    assert np.array_equal(handle.colors, [[[255, 0, 0], [255, 0, 0]]])


def test_triangles_lie_a_little_in_front_of_the_mesh_that_they_are_of(nodes: SceneNodes) -> None:
    nodes.begin()
    nodes.triangles("/patch", TRIANGLE, (255, 0, 0))
    vertices = nodes._handles["/patch"].vertices
    assert np.allclose(vertices - TRIANGLE[0], [0.0, 0.0, LIFT], atol=1e-7)


def test_a_triangle_without_an_area_stays_where_it_is(nodes: SceneNodes) -> None:
    nodes.begin()
    nodes.triangles("/patch", np.zeros((1, 3, 3), dtype=np.float32), (255, 0, 0))
    assert np.array_equal(nodes._handles["/patch"].vertices, np.zeros((3, 3)))


def test_a_coloured_mesh_and_a_label_are_changed_in_place(nodes: SceneNodes) -> None:
    for shade, text in ((0, "5 mm"), (255, "7 mm")):
        nodes.begin()
        colors = np.full((3, 3), shade, dtype=np.uint8)
        nodes.colored_mesh("/fit", TRIANGLE[0], np.array([[0, 1, 2]]), colors)
        nodes.label("/worst", text, np.array([0.0, 0.0, 1.0]))
        nodes.end()
        assert nodes._handles["/worst"].text == text
    assert nodes._handles["/fit"].glb_data[:4] == b"glTF" and len(nodes._handles) == 2
