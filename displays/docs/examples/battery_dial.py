"""A panel with a widget of its own: a dial, on which a click sets the limit of a warning."""

from collections.abc import Mapping
from typing import Any

from webviz import Panel, Send, Ui


class BatteryDial(Panel):
    """The charge of the battery."""

    title = "Battery"
    module = "battery_dial.js"
    opens = "side"

    def build(self, ui: Ui, send: Send) -> None:
        """Add the dial."""
        self.charge, self.limit = 0.0, 0.2
        self.dial = ui.widget("dial", {}, self.set_limit)

    def subscriptions(self) -> Mapping[str, str]:
        """Read the battery."""
        return {"/battery_state": "sensor_msgs/msg/BatteryState"}

    def take(self, topic: str, message: Any) -> None:
        """Take its charge."""
        self.charge = float(message.percentage)

    def set_limit(self, value: Any, browser: int | None) -> None:
        """Warn below this charge from now on."""
        self.limit = min(1.0, max(0.0, float(value)))

    def show(self) -> None:
        """Show the charge and the limit."""
        self.dial.show({"charge": self.charge, "limit": self.limit})
