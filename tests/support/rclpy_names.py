"""Names of rclpy that not all distributions have, by the one that brought them.

Read from the sources of rclpy 3.3.15 (Humble), 4.1.7 (Iron), 7.1.6 (Jazzy) and 9.1.2 (Kilted).
"""

from __future__ import annotations

DISTRIBUTIONS = "humble", "iron", "jazzy", "kilted"
"""The oldest first."""

MODULES = {
    "iron": {
        "rclpy.event_handler",
        "rclpy.logging_service",
        "rclpy.parameter_client",
        "rclpy.service_introspection",
        "rclpy.type_description_service",
        "rclpy.type_hash",
    },
    "jazzy": {
        "rclpy.clock_type",
        "rclpy.experimental",
        "rclpy.experimental.events_executor",
        "rclpy.parameter_event_handler",
    },
    "kilted": {"rclpy.subscription_content_filter_options"},
}
ELSEWHERE = {"rclpy.destroyable", "rclpy.qos_event", "rclpy.topic_endpoint_info"}
"""Modules of Jazzy alone, deprecated since Iron, and `rclpy.endpoint_info` in Lyrical."""

ATTRIBUTES = {
    "iron": {
        "Client.configure_introspection",
        "Node.add_post_set_parameters_callback",
        "Node.add_pre_set_parameters_callback",
        "Node.get_fully_qualified_node_names",
        "Node.remove_post_set_parameters_callback",
        "Node.remove_pre_set_parameters_callback",
        "Node.wait_for_node",
        "Service.configure_introspection",
        "Subscription.get_publisher_count",
        "TopicEndpointInfo.topic_type_hash",
    },
    "jazzy": {
        "Client.logger_name",
        "Client.service_name",
        "Future.remove_done_callback",
        "Node.count_clients",
        "Node.count_services",
        "Node.list_parameters",
        "Publisher.logger_name",
        "Service.logger_name",
        "Service.service_name",
        "Subscription.logger_name",
    },
    "kilted": {
        "Context.track_node",
        "Context.untrack_node",
        "Executor.create_future",
        "Subscription.get_content_filter",
        "Subscription.is_cft_enabled",
        "Subscription.set_content_filter",
    },
}
"""Public ones of the classes that webviz uses."""

KEYWORDS = {
    "iron": {"enable_logger_service"},
    "jazzy": {"autostart"},
    "kilted": {"content_filter_options", "rosout_qos_profile"},
}
"""Keywords of the node and its methods."""


def newer_than(distribution: str, names: dict[str, set[str]]) -> set[str]:
    """Return the names that a distribution lacks, since a newer one brought them."""
    newer = DISTRIBUTIONS[DISTRIBUTIONS.index(distribution) + 1 :]
    return set().union(*(names.get(each, set()) for each in newer))
