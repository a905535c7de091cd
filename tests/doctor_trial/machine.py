"""Faults of the machine, its network and its shared memory."""

from __future__ import annotations

from tests.doctor_trial.provocation import Provocation

RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"
SHM = "mount -t tmpfs none /dev/shm -o"
VPN = (
    "ip link add tun0 type veth peer name far; ip address add 198.51.100.9/24 dev tun0; "
    "ip link set tun0 up; ip link set far up; ip route add 224.0.0.0/4 dev tun0"
)
PROFILES = "FASTRTPS_DEFAULT_PROFILES_FILE"

ALL = [
    Provocation("all is well", "", ""),
    Provocation("domain out of range", "ENV001", "ROS_DOMAIN_ID", here={"ROS_DOMAIN_ID": "233"}),
    Provocation(
        "domain that is not a number", "ENV001", "ROS_DOMAIN_ID", here={"ROS_DOMAIN_ID": "robot"}
    ),
    Provocation("another domain", "GRAPH001", "ROS_DOMAIN_ID", here={"ROS_DOMAIN_ID": "7"}),
    Provocation(
        "robot in another domain", "GRAPH001", "ROS_DOMAIN_ID", there={"ROS_DOMAIN_ID": "7"}
    ),
    Provocation("no robot", "GRAPH001", "robot", is_alone=True),
    Provocation("discovery is off", "ENV003", RANGE, here={RANGE: "OFF"}),
    Provocation("discovery range is invalid", "ENV004", RANGE, here={RANGE: "LAN"}),
    Provocation(
        "discovery of this machine only", "ENV016", RANGE, here={RANGE: "LOCALHOST"}, is_alone=True
    ),
    Provocation(
        "localhost only",
        "ENV016",
        "ROS_LOCALHOST_ONLY",
        here={"ROS_LOCALHOST_ONLY": "1"},
        is_alone=True,
    ),
    Provocation(
        "localhost only against the range",
        "ENV005",
        "ROS_LOCALHOST_ONLY",
        here={"ROS_LOCALHOST_ONLY": "1", RANGE: "SUBNET"},
    ),
    Provocation(
        "middleware that is not installed",
        "ENV006",
        "RMW_IMPLEMENTATION",
        here={"RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp"},
    ),
    Provocation(
        "profile that is missing", "ENV007", "remove the variable", here={PROFILES: "/missing.xml"}
    ),
    Provocation(
        "profile that is no XML",
        "ENV007",
        "xmllint",
        here={PROFILES: "dds.xml"},
        files={"dds.xml": "<dds><profiles>"},
    ),
    Provocation(
        "discovery server that is off",
        "ENV012",
        "",
        here={"ROS_DISCOVERY_SERVER": "127.0.0.1:11811"},
    ),
    Provocation("security without a keystore", "ENV014", "", here={"ROS_SECURITY_ENABLE": "true"}),
    Provocation(
        "security that is enforced without a keystore",
        "ENV014",
        "",
        here={"ROS_SECURITY_ENABLE": "true", "ROS_SECURITY_STRATEGY": "Enforce"},
    ),
    Provocation(
        "two distributions",
        "ENV009",
        "",
        here={"AMENT_PREFIX_PATH": "/opt/ros/humble:/opt/ros/jazzy"},
    ),
    Provocation(
        "Python of another distribution",
        "ENV015",
        "",
        here={"PYTHONPATH": "/opt/ros/foxy/lib/python3.8/site-packages"},
    ),
    Provocation("no network", "NET003", "network", shell="ip link del eth0", is_alone=True),
    Provocation(
        "no multicast",
        "NET001",
        "",
        shell="ip link set eth0 multicast off; ip link set eth1 multicast off",
        is_alone=True,
    ),
    Provocation(
        "no route for multicast", "NET002", "", shell="ip route del default", is_alone=True
    ),
    Provocation(
        "multicast through a VPN",
        "NET010",
        "",
        shell=VPN,
        is_alone=True,
    ),
    Provocation("small packets", "NET005", "", shell="ip link set eth0 mtu 1400"),
    Provocation("shared memory is small", "SHM002", "", shell=f"{SHM} size=16m"),
    Provocation(
        "shared memory is full",
        "SHM003",
        "",
        shell=f"{SHM} size=100m; head -c 99m /dev/zero > /dev/shm/full",
    ),
    Provocation(
        "shared memory that cannot be written", "SHM006", "", shell="mount -o remount,ro /dev/shm"
    ),
    Provocation("lock without a segment", "SHM004", "", shell="touch /dev/shm/fastrtps_port7_el"),
    Provocation("robot with other shared memory", "SHM005", "ipc", apart=f"{SHM} size=1g"),
]
