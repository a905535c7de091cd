// The icon of each type of display.

const ICONS = {
  Axes: "axes",
  Camera: "camera",
  CameraInfo: "camera",
  DepthCloud: "cloud",
  Grid: "grid",
  Image: "camera",
  ImagePlane: "camera",
  Group: "folder",
  LaserScan: "laser",
  Map: "map",
  Odometry: "odometry",
  Path: "path",
  PointCloud: "cloud",
  PointCloud2: "cloud",
  RobotModel: "robot",
  TF: "tree",
};

/** The name of the icon of a display type; a plug-in's has a plain one. */
export const typeIcon = (type) => ICONS[type] ?? "plug";
