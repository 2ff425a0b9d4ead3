# SPDX-License-Identifier: BSD-3-Clause
"""Shapes of bodies, and their filling with particles."""

from .base import KINDS, AnyShape, Shape, parse_shape
from .booleans import Difference, Intersection, Union
from .filling import fill, reference_volume
from .inclined import Frustum, Funnel, Polygon
from .ogive import OgiveRod
from .primitives import Box, Cylinder, Disc, Ring, Sphere, Tube
from .transforms import Rotate, Translate

__all__ = [
    "KINDS",
    "AnyShape",
    "Box",
    "Cylinder",
    "Difference",
    "Disc",
    "Frustum",
    "Funnel",
    "Intersection",
    "OgiveRod",
    "Polygon",
    "Ring",
    "Rotate",
    "Shape",
    "Sphere",
    "Translate",
    "Tube",
    "Union",
    "fill",
    "parse_shape",
    "reference_volume",
]
