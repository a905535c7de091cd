"""Definitions of services and actions that tools and panels use, without their packages.

Field names and types are the interfaces of navigation2, MoveIt and slam_toolbox in ROS 2 Jazzy.
"""

SERVICES = {
    "std_srvs/srv/Empty": "---",
    "std_srvs/srv/SetBool": """bool data
---
bool success
string message""",
    "std_srvs/srv/Trigger": """---
bool success
string message""",
    "action_msgs/srv/CancelGoal": """int8 ERROR_NONE=0
int8 ERROR_REJECTED=1
int8 ERROR_UNKNOWN_GOAL_ID=2
int8 ERROR_GOAL_TERMINATED=3
action_msgs/GoalInfo goal_info
---
int8 return_code
action_msgs/GoalInfo[] goals_canceling""",
    "visualization_msgs/srv/GetInteractiveMarkers": """---
uint64 sequence_number
visualization_msgs/InteractiveMarker[] markers""",
    "moveit_msgs/srv/GetPlanningScene": """moveit_msgs/PlanningSceneComponents components
---
moveit_msgs/PlanningScene scene""",
    "moveit_task_constructor_msgs/srv/GetSolution": """uint32 solution_id
---
moveit_task_constructor_msgs/Solution solution""",
    "rcl_interfaces/srv/DescribeParameters": """string[] names
---
rcl_interfaces/ParameterDescriptor[] descriptors""",
    "rcl_interfaces/srv/GetParameters": """string[] names
---
rcl_interfaces/ParameterValue[] values""",
    "rcl_interfaces/srv/ListParameters": """uint64 DEPTH_RECURSIVE=0
string[] prefixes
uint64 depth
---
rcl_interfaces/ListParametersResult result""",
    "rcl_interfaces/srv/SetParameters": """rcl_interfaces/Parameter[] parameters
---
rcl_interfaces/SetParametersResult[] results""",
    "slam_toolbox/srv/Pause": """---
bool status""",
    "slam_toolbox/srv/ToggleInteractive": "---",
    "slam_toolbox/srv/Clear": "---",
    "slam_toolbox/srv/LoopClosure": "---",
    "slam_toolbox/srv/ClearQueue": """---
bool status""",
    "slam_toolbox/srv/SaveMap": """std_msgs/String name
---
uint8 RESULT_SUCCESS=0
uint8 RESULT_NO_MAP_RECEIEVD=1
uint8 RESULT_UNDEFINED_FAILURE=255
uint8 result""",
    "slam_toolbox/srv/SerializePoseGraph": """string filename
---
uint8 RESULT_SUCCESS=0
uint8 RESULT_FAILED_TO_WRITE_FILE=255
uint8 result""",
    "slam_toolbox/srv/DeserializePoseGraph": """int8 UNSET=0
int8 START_AT_FIRST_NODE=1
int8 START_AT_GIVEN_POSE=2
int8 LOCALIZE_AT_POSE=3
string filename
int8 match_type
geometry_msgs/Pose2D initial_pose
---""",
    "slam_toolbox/srv/AddSubmap": """string filename
---""",
    "slam_toolbox/srv/MergeMaps": "---",
    "nav2_msgs/srv/ManageLifecycleNodes": """uint8 STARTUP=0
uint8 PAUSE=1
uint8 RESUME=2
uint8 RESET=3
uint8 SHUTDOWN=4
uint8 CONFIGURE=5
uint8 CLEANUP=6
uint8 command
---
bool success""",
}

ACTIONS = {
    "nav2_msgs/action/DockRobot": """bool use_dock_id
string dock_id
geometry_msgs/PoseStamped dock_pose
string dock_type
float32 max_staging_time
bool navigate_to_staging_pose
---
bool success
uint16 error_code
uint16 num_retries
string error_msg
---
uint16 state
builtin_interfaces/Duration docking_time
uint16 num_retries""",
    "nav2_msgs/action/UndockRobot": """string dock_type
float32 max_undocking_time
---
bool success
uint16 error_code
string error_msg
---""",
    "nav2_msgs/action/NavigateToPose": """geometry_msgs/PoseStamped pose
string behavior_tree
---
uint16 error_code
string error_msg
---
geometry_msgs/PoseStamped current_pose
builtin_interfaces/Duration navigation_time
builtin_interfaces/Duration estimated_time_remaining
int16 number_of_recoveries
float32 distance_remaining""",
    "nav2_msgs/action/NavigateThroughPoses": """geometry_msgs/PoseStamped[] poses
string behavior_tree
---
uint16 error_code
string error_msg
---
geometry_msgs/PoseStamped current_pose
builtin_interfaces/Duration navigation_time
builtin_interfaces/Duration estimated_time_remaining
int16 number_of_recoveries
float32 distance_remaining
int16 number_of_poses_remaining""",
    "nav2_msgs/action/FollowWaypoints": """uint32 number_of_loops
uint32 goal_index
geometry_msgs/PoseStamped[] poses
---
nav2_msgs/MissedWaypoint[] missed_waypoints
uint16 error_code
string error_msg
---
uint32 current_waypoint""",
}
