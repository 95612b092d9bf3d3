"""Robot descriptions (URDF): reading them safely, their axes as joints of an arm, and the frames in between."""
