"""An arm for other programs: as a URDF for ROS, as a table of Denavit–Hartenberg parameters for a controller."""
