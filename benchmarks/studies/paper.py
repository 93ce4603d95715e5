"""The numbers that T16 prints: px on its recordings, against manual annotations."""

from __future__ import annotations

TABLE_2_ITERATIONS = (5, 10, 15, 20, 30)
TABLE_2 = {"point-to-point": (7.33, 5.25, 5.05, 4.98, 4.91), "point-to-plane": (5.33, 5.12, 5.08, 5.07, 5.05)}

TABLE_3_LAMBDA = (0.0, 0.3, 0.6, 0.9, 1.2, 1.5, 1.8)
TABLE_3 = {
    "w_s = 1": (5.17, 5.17, 5.15, 5.14, 5.12, 5.12, 5.23),
    "w_s = c_s / c_thr": (5.17, 5.14, 5.12, 5.12, 5.12, 5.22, 5.61),
}
"""λ = 0 is without salient points, printed once."""

TABLE_4_WEIGHT = (0.0, 1.0, 2.0, 3.0, 5.0, 7.5, 10.0, 12.5)
TABLE_4 = {
    "all": (5.34, 5.44, 5.57, 5.16, 5.12, 5.12, 5.12, 5.14),
    "severe": (5.90, 6.07, 6.27, 5.62, 5.56, 5.57, 5.55, 5.61),
    "at least some": (5.44, 5.57, 5.72, 5.23, 5.18, 5.19, 5.18, 5.22),
    "some": (3.99, 3.98, 3.98, 3.98, 3.98, 3.99, 3.99, 3.98),
}

TABLE_5 = {
    "all": (6.66, 5.12),
    "severe": (7.96, 5.55),
    "at least some": (7.04, 5.18),
    "some": (4.12, 3.99),
}
"""Corresponding vertices, distance fields."""

TABLE_6 = {
    "LO m2d": ("27.17", "1/11"),
    "LO d2m": ("-", "11/11"),
    "LO": ("5.53", "0/11"),
    "LO+C": ("5.17", "0/11"),
    "LO+S": ("5.34", "0/11"),
    "LO+SC": ("5.12", "0/11"),
}
"""Mean px, sequences in which the pose collapsed."""

TABLE_7 = {
    "Walking": (5.99, 3.65, 24.19),
    "Crossing": (4.53, 2.99, 18.03),
    "Crossing and Twisting": (4.76, 3.51, 22.80),
    "Tips Touching": (3.65, 2.21, 13.60),
    "Dancing": (6.49, 3.70, 20.25),
    "Tips Blending": (4.87, 2.97, 18.36),
    "Hugging": (5.22, 3.42, 20.03),
    "Grasping": (4.37, 2.06, 11.05),
    "Flying": (5.11, 2.77, 15.03),
    "Rock": (4.44, 2.63, 14.76),
    "Bunny": (4.50, 2.61, 10.63),
}
"""Mean, standard deviation, max."""

TABLE_8 = {
    "25 x 64": (8.58, 5.74, 61.81),
    "40 x 64": (8.32, 5.42, 57.97),
    "40 x 128": (8.09, 5.00, 38.90),
    "45 x 64": (8.16, 5.18, 39.85),
    "ours": (3.76, 2.22, 19.92),
}
"""Generations x particles: mean, standard deviation, max."""

TABLE_11_FRICTION = (0.6, 0.9, 1.2, 1.5, 3.0)
TABLE_11 = {"mean": (6.19, 6.18, 6.19, 6.17, 6.17), "std": (3.82, 3.81, 3.81, 3.81, 3.81)}

TABLE_12_WEIGHT = (0.0, 1.0, 2.0, 3.0, 5.0, 7.5, 10.0, 12.5)
TABLE_12 = {
    "all": (6.21, 6.20, 6.21, 6.19, 6.19, 6.18, 6.19, 6.17),
    "severe": (5.68, 5.66, 5.65, 5.63, 5.63, 5.63, 5.62, 5.61),
    "at least some": (6.02, 6.00, 6.00, 5.98, 5.98, 5.97, 5.96, 5.94),
}

TABLE_13 = {
    "LO+SCP": (6.19, 3.81, 6.25, 3.86),
    "LO+SC": (6.21, 3.82, 6.31, 3.89),
    "LO+S": (6.05, 3.76, 6.09, 3.77),
    "LO+CP": (6.19, 3.83, 6.31, 3.90),
    "LO+C": (6.24, 3.84, 6.38, 3.94),
    "LO": (6.07, 3.77, 6.15, 3.83),
}
"""Mean and standard deviation with ten iterations; with the stop at 0.2 mm."""

DISPLACEMENT_MM = {"LO+SC": 9.26, "LO+SCP": 9.05}
"""§4.2.1: mean displacement of the object's centroid in the simulation afterwards."""

FIGURE_13_AUC = {"depth": 0.19, "colour": 0.55, "Dexter depth": 0.95}

FIGURE_16_WITHIN_TEN = 0.92
"""Share of frames in which LO+SCP stops within ten iterations, as the text says; the curves are not printed."""

TABLE_14 = {
    "Moving a Ball": (6.10, 3.90),
    "Moving a Ball, 2 hands": (7.15, 4.82),
    "Bending a Pipe": (6.09, 3.07),
    "Bending a Rope": (5.65, 3.04),
    "Moving a Ball, occlusion": (8.03, 5.47),
    "Moving a Cube": (4.68, 2.61),
    "Moving a Cube, occlusion": (5.55, 3.28),
}
"""Mean, standard deviation."""
