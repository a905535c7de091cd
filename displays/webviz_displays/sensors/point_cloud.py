"""The PointCloud display."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np

from webviz import Input, Prop, Topic
from webviz.data import messages
from webviz.data.words import listed
from webviz_displays.point_cloud2.cloud import Cloud
from webviz_displays.point_cloud2.display import CloudDisplay

_FLOAT = np.dtype(np.float32)


class PointCloud(CloudDisplay):
    """Points of a 3D sensor, in the message type before PointCloud2."""

    rviz = "rviz_default_plugins/PointCloud"
    icon = "cloud"

    topic: Annotated[
        Topic, Input("sensor_msgs/msg/PointCloud"), Prop(help="Topic of the clouds.")
    ] = Topic("/point_cloud")

    def cloud_of(self, message: Any) -> Cloud:
        """Return the message with its channels as fields; those of another length are left out."""
        points, channels = message.points, message.channels
        fitting = [channel for channel in channels if len(channel.values) == len(points)]
        names = ["x", "y", "z", *(channel.name for channel in fitting)]
        data = np.empty((len(points), len(names)), _FLOAT)
        data[:, :3] = points
        for column, channel in enumerate(fitting, 3):
            data[:, column] = channel.values
        step = data.shape[1] * _FLOAT.itemsize
        cloud = Cloud(
            messages.PointCloud2(
                header=message.header,
                height=1,
                width=len(points),
                fields=[
                    messages.PointField(name, i * _FLOAT.itemsize, messages.PointField.FLOAT32, 1)
                    for i, name in enumerate(names)
                ],
                point_step=step,
                row_step=step * len(points),
                data=data.view(np.uint8).reshape(-1),
            )
        )
        others = [channel for channel in channels if len(channel.values) != len(points)]
        if others:
            said = [f"{channel.name!r:.40} with {len(channel.values)}" for channel in others]
            cloud.remark = (
                f"Channels do not have one value for each of the {len(points)} points and are "
                f"ignored: {listed(said, 5)}. Fix the publisher."
            )
        return cloud
