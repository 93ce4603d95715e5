"""What is rendered is the surface, and joints are where the model has them."""

from __future__ import annotations

import numpy as np

from tracker.geometry import se3
from tracker.model.scene import Scene
from tracker.synthesis.performance import render_moment


def test_rendered_depth_projects_back_onto_the_triangle_it_shows(performance):
    camera = performance.camera
    for index in range(performance.num_moments):
        moment = render_moment(performance, index)
        rows, columns = np.nonzero(moment.face >= 0)
        assert len(rows) > 400
        depth = moment.depth[rows, columns]
        rays = np.column_stack([columns, rows, np.ones(len(rows))]) @ np.linalg.inv(camera.K).T
        points = se3.transform(camera.T_world_camera, rays * depth[:, None])
        a, b, c = moment.vertices[performance.faces[moment.face[rows, columns]]].transpose(1, 0, 2)
        system = np.stack([b - a, c - a, np.cross(b - a, c - a)], axis=2)
        shares = np.linalg.solve(system, (points - a)[:, :, None])[:, :, 0]
        lengths = np.linalg.norm(system[:, :, 2], axis=1)
        assert np.max(np.abs(shares[:, 2] * lengths)) < 1e-9, "m from the plane of the triangle"
        assert np.all(shares[:, :2] > -1e-6) and np.all(shares[:, 0] + shares[:, 1] < 1 + 1e-6)


def test_joints_project_where_the_camera_says_and_stand_where_the_scene_says(performance):
    (actor,) = performance.actors
    assert performance.joint_names == ("tube:bone_0", "tube:bone_1", "tube:bone_2")
    moment = render_moment(performance, 3)
    np.testing.assert_allclose(moment.pixels, performance.camera.project(moment.joints), atol=1e-9)
    pose = Scene((actor.model,)).rest_pose()
    pose[:6] = se3.log(actor.T_world_model(3))
    pose[6:] = 0.08 * 3
    posed = Scene((actor.model,)).pose_at(pose)
    np.testing.assert_allclose(moment.joints, posed.landmarks(0), atol=1e-12)
    np.testing.assert_allclose(moment.vertices, posed.vertices[: len(actor.model.vertices)], atol=1e-9)
