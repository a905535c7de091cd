"""Details of a selected odometry message."""

from __future__ import annotations

from typing import Any

import numpy as np

from webviz import Details, Pose, Sample
from webviz.data import messages
from webviz.data.rotations import normalized

_AXES = ("x", "y", "z", "roll", "pitch", "yaw")


def odometry_details(sample: Sample) -> Details:
    """Pose, twist and covariances of a message."""
    message: messages.Odometry = sample.message
    p, q = message.pose.pose.position, message.pose.pose.orientation
    (wxyz,), _ = normalized([(q.w, q.x, q.y, q.z)])
    twist = message.twist.twist
    return Details(
        f"Odometry {sample.number}",
        {
            "Speed": f"{_vector(twist.linear)} m/s",
            "Turn rate": f"{_vector(twist.angular)} rad/s",
            f"Pose in {sample.frame}": Pose((p.x, p.y, p.z), tuple(wxyz.tolist())),
            "Child frame": message.child_frame_id,
            **covariance_details(message.pose.covariance),
            "Covariance of the twist": _rows(message.twist.covariance),
        },
    )


def covariance_details(covariance: Any) -> dict[str, object]:
    """Return the details of the covariance (36,) of a pose."""
    return {
        "Standard deviations": _deviations(covariance),
        "Covariance of the pose": _rows(covariance),
    }


def _vector(v: messages.Vector3) -> str:
    return f"{v.x:.4g}, {v.y:.4g}, {v.z:.4g}"


def _deviations(covariance: Any) -> str:
    """Return the deviations along or about the axes, "?" for a negative variance."""
    variances = np.asarray(covariance).reshape(6, 6).diagonal()
    texts = [f"{np.sqrt(v):.4g}" if v >= 0 else "?" for v in variances]
    return ", ".join(f"{axis} {text}" for axis, text in zip(_AXES, texts, strict=True))


def _rows(covariance: Any) -> dict[str, object]:
    """Return the rows of a matrix by their axes."""
    matrix = np.asarray(covariance).reshape(6, 6)
    return {
        axis: ", ".join(f"{v:.4g}" for v in row) for axis, row in zip(_AXES, matrix, strict=True)
    }
