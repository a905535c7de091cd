"""Definitions of messages about parts of images.

Field names and types are those of vision_msgs 4.1 and foxglove_msgs 3.2, in the order of the wire.
"""

ANNOTATIONS = {
    "vision_msgs/msg/Point2D": """
        float64 x
        float64 y""",
    "vision_msgs/msg/Pose2D": """
        vision_msgs/Point2D position
        float64 theta""",
    "vision_msgs/msg/BoundingBox2D": """
        vision_msgs/Pose2D center
        float64 size_x
        float64 size_y""",
    "vision_msgs/msg/Detection2D": """
        std_msgs/Header header
        vision_msgs/ObjectHypothesisWithPose[] results
        vision_msgs/BoundingBox2D bbox
        string id""",
    "vision_msgs/msg/Detection2DArray": """
        std_msgs/Header header
        vision_msgs/Detection2D[] detections""",
    "foxglove_msgs/msg/Color": """
        float64 r
        float64 g
        float64 b
        float64 a""",
    "foxglove_msgs/msg/KeyValuePair": """
        string key
        string value""",
    "foxglove_msgs/msg/Point2": """
        float64 x
        float64 y""",
    "foxglove_msgs/msg/CircleAnnotation": """
        builtin_interfaces/Time timestamp
        foxglove_msgs/Point2 position
        float64 diameter
        float64 thickness
        foxglove_msgs/Color fill_color
        foxglove_msgs/Color outline_color
        foxglove_msgs/KeyValuePair[] metadata""",
    "foxglove_msgs/msg/PointsAnnotation": """
        uint8 UNKNOWN=0
        uint8 POINTS=1
        uint8 LINE_LOOP=2
        uint8 LINE_STRIP=3
        uint8 LINE_LIST=4
        builtin_interfaces/Time timestamp
        uint8 type
        foxglove_msgs/Point2[] points
        foxglove_msgs/Color outline_color
        foxglove_msgs/Color[] outline_colors
        foxglove_msgs/Color fill_color
        float64 thickness
        foxglove_msgs/KeyValuePair[] metadata""",
    "foxglove_msgs/msg/TextAnnotation": """
        builtin_interfaces/Time timestamp
        foxglove_msgs/Point2 position
        string text
        float64 font_size
        foxglove_msgs/Color text_color
        foxglove_msgs/Color background_color
        foxglove_msgs/KeyValuePair[] metadata""",
    "foxglove_msgs/msg/ImageAnnotations": """
        builtin_interfaces/Time timestamp
        foxglove_msgs/CircleAnnotation[] circles
        foxglove_msgs/PointsAnnotation[] points
        foxglove_msgs/TextAnnotation[] texts
        foxglove_msgs/KeyValuePair[] metadata""",
}
