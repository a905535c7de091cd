"""The ParticleCloud display."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from webviz import Context, Details, Display, Hit, Input, Prop, Remedy, Sample, Topic
from webviz.data.messages import PoseSequence
from webviz_displays.poses.pose_set import (
    ArrowAlpha,
    ArrowColor,
    Shape,
    is_invisible,
    pose_details,
    pose_set,
)
from webviz_displays.shared.geometry import Length
from webviz_displays.shared.history import HistoryLength

SHAFT_RADIUS, HEAD_LENGTH, HEAD_RADIUS = 0.0435 / 2, 0.3043, 0.1304 / 2
"""Shares of the length of a solid arrow; RViz gives the diameters."""

AXES_RADIUS = 0.0435 / 2
"""Share of the length of axes; RViz gives the diameter."""

_POSITION, _ORIENTATION, _WEIGHT = slice(0, 3), slice(3, 7), 7
"""Columns of the particles."""


class ParticleCloud(Display):
    """Where a particle filter such as amcl supposes the robot, with the weight of each guess."""

    rviz = "nav2_rviz_plugins/ParticleCloud"
    is_threaded = True

    topic: Annotated[
        Topic, Input("nav2_msgs/msg/ParticleCloud"), Prop(help="Topic of the particles.")
    ] = Topic("/particle_cloud")
    shape: Shape = "Arrow (Flat)"
    color: ArrowColor = (255, 25, 0)
    alpha: ArrowAlpha = 1.0
    min_arrow_length: Annotated[Length, Prop(help="Length of a particle without weight.")] = 0.02
    max_arrow_length: Annotated[Length, Prop(help="Length of a particle of weight 1.")] = 0.3
    history_length: HistoryLength = 1

    def draw(self, sample: Sample, ctx: Context) -> None:
        """One cloud, in the frame and at the stamp of its header."""
        particles = sample.message.particles
        found = pose_set(
            particles[:, _POSITION], particles[:, _ORIENTATION], sample, ctx, "particle"
        )
        if found is None:
            return
        low, high = self.min_arrow_length, self.max_arrow_length
        weights = particles[found.ids, _WEIGHT]
        if low > high:
            ctx.warn(
                "Length",
                "Min Arrow Length exceeds Max Arrow Length. Swap them.",
                Remedy("min_arrow_length", high, f"Set Min Arrow Length to {high:g} m"),
            )
            low, high = high, low
        if not np.isfinite(weights).all():
            ctx.warn("Weight", "Weights are not finite and count as 0. Fix the publisher.")
            weights = np.where(np.isfinite(weights), weights, 0.0)
        lengths = low + np.clip(weights, 0.0, 1.0) * (high - low)
        if self.shape == "Axes":
            found.draw_axes(lengths, AXES_RADIUS * lengths)
        elif is_invisible(self.alpha, ctx, "particle"):
            return
        elif self.shape == "Arrow (Flat)":
            found.draw_flat(lengths, self.color, self.alpha)
        else:
            sizes = SHAFT_RADIUS * lengths, HEAD_RADIUS * lengths, HEAD_LENGTH * lengths
            found.draw_arrows(lengths, *sizes, self.color, self.alpha)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return a particle: its weight and its pose in its own frame."""
        particles = hit.sample.message.particles
        poses = PoseSequence(particles[:, _POSITION], particles[:, _ORIENTATION])
        found = pose_details(hit, "Particle", poses[hit.id], len(particles))
        return Details(found.title, {"Weight": particles[hit.id, _WEIGHT], **found.values})
