"""Definitions of messages of MoveIt Task Constructor and of RTAB-Map's statistics.

Field names and types are those of moveit_task_constructor_msgs 0.1 and rtabmap_msgs 0.22, in the
order of the wire.
"""

PLANNING = {
    "moveit_task_constructor_msgs/msg/Property": """
        string name
        string description
        string type
        string value""",
    "moveit_task_constructor_msgs/msg/StageDescription": """
        uint32 id
        uint32 parent_id
        string name
        uint32 flags
        moveit_task_constructor_msgs/Property[] properties""",
    "moveit_task_constructor_msgs/msg/TaskDescription": """
        string task_id
        moveit_task_constructor_msgs/StageDescription[] stages""",
    "moveit_task_constructor_msgs/msg/StageStatistics": """
        uint32 id
        uint32[] solved
        uint32[] failed
        uint32 num_failed
        float64 total_compute_time""",
    "moveit_task_constructor_msgs/msg/TaskStatistics": """
        string task_id
        moveit_task_constructor_msgs/StageStatistics[] stages""",
    "moveit_task_constructor_msgs/msg/SolutionInfo": """
        uint32 id
        float32 cost
        string comment
        uint32 stage_id
        string planner_id
        visualization_msgs/Marker[] markers""",
    "moveit_task_constructor_msgs/msg/SubSolution": """
        moveit_task_constructor_msgs/SolutionInfo info
        uint32[] sub_solution_id""",
    "moveit_task_constructor_msgs/msg/TrajectoryExecutionInfo": """
        string[] controller_names""",
    "moveit_task_constructor_msgs/msg/SubTrajectory": """
        moveit_task_constructor_msgs/SolutionInfo info
        moveit_task_constructor_msgs/TrajectoryExecutionInfo execution_info
        moveit_msgs/RobotTrajectory trajectory
        moveit_msgs/PlanningScene scene_diff""",
    "moveit_task_constructor_msgs/msg/Solution": """
        string task_id
        moveit_msgs/PlanningScene start_scene
        moveit_task_constructor_msgs/SubSolution[] sub_solution
        moveit_task_constructor_msgs/SubTrajectory[] sub_trajectory""",
    "rtabmap_msgs/msg/Info": """
        std_msgs/Header header
        int32 ref_id
        int32 loop_closure_id
        int32 proximity_detection_id
        int32 landmark_id
        geometry_msgs/Transform loop_closure_transform
        int32[] wm_state
        int32[] posterior_keys
        float32[] posterior_values
        int32[] likelihood_keys
        float32[] likelihood_values
        int32[] raw_likelihood_keys
        float32[] raw_likelihood_values
        int32[] weights_keys
        int32[] weights_values
        int32[] labels_keys
        string[] labels_values
        string[] stats_keys
        float32[] stats_values
        int32[] local_path
        int32 current_goal_id
        rtabmap_msgs/MapGraph odom_cache""",
}
