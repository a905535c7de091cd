"""The panel "Doctor": what the doctor has found, as cards with what to do.

Its findings are those of `webviz.engine.doctor`, which explain statuses in other places, too.
"""

from webviz.engine.feature import Feature


class DoctorFeature(Feature):
    """The panel of the doctor."""

    name = "Doctor panel"
    module = "doctor.js"
