#pragma once

#include <cmath>
#include <vector>

#include "lowlap/scene/view.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {

/// A parallelogram that carries features: origin + a u + b v with a, b in
/// [0, 1] and u, v its sides. Cameras see its inner side.
struct Wall {
  Vec3 origin = Vec3::Zero();
  Vec3 u = Vec3::UnitX();
  Vec3 v = Vec3::UnitY();
  Vec3 inward = Vec3::UnitZ();  // unit normal, towards the cameras
  int plane = 0;                // sections of one wall share it
  double clearance = 1.0;       // how far a line may be moved off, in metres
  double bulge = 0;             // SyntheticOptions::wall_bulge_m
  double box_offset = 0;        // SyntheticOptions::box_offset_m
  int box_plane = -1;           // of the box's front
  int alike_wall = -1;  // before this one and of the same shape: what is
                        // there is here, too

  Vec3 At(double a, double b) const { return origin + a * u + b * v; }
  /// The box covers the middle three fifths in both directions.
  bool HasBoxAt(double a, double b) const {
    return box_offset > 0 && std::abs(a - 0.5) < 0.3 && std::abs(b - 0.5) < 0.3;
  }
  /// Of the bowed wall, or of the box before it.
  Vec3 SurfaceAt(double a, double b) const {
    const double before =
        (HasBoxAt(a, b) ? box_offset : 0) - 4 * bulge * a * (1 - a);
    return At(a, b) + before * inward;
  }
  /// Rows: along u, across it, and inward.
  Mat3 Axes() const {
    Mat3 axes;
    axes.row(0) = u.normalized();
    axes.row(1) = inward.cross(u).normalized();
    axes.row(2) = inward;
    return axes;
  }
};

struct WorldPoint {
  Vec3 position = Vec3::Zero();
  int wall = 0;
  int alike = -1;  // index of the point that it is a copy of
};

struct WorldLine {
  Vec3 start = Vec3::Zero();
  Vec3 end = Vec3::Zero();
  int wall = 0;             // decides which cameras face it
  std::vector<int> planes;  // as SyntheticLine::planes
  int alike = -1;           // index of the line that it is a copy of
};

/// What there is to see, and from where.
struct World {
  std::vector<Vec4> planes;
  std::vector<Wall> walls;
  std::vector<WorldPoint> points;
  std::vector<WorldLine> lines;
  std::vector<Pose> poses;  // by view
  double max_range = 1e9;   // metres; what is farther is not seen

  /// Adds a wall whose inner side is that of `seen_from`, on a plane of its own
  /// unless `plane` names one that exists; returns its index.
  int AddWall(const Vec3& origin, const Vec3& u, const Vec3& v,
              const Vec3& seen_from, double clearance, int plane = -1);
};

/// Walls, edges and cameras of the options' kind.
World BuildLayout(const SyntheticOptions& options);

/// Points and lines on every wall, or before it in a cloud. A share `off_wall`
/// of the lines is moved off towards the cameras; for one seed, a greater share
/// moves the same lines and more.
void FillWalls(const SyntheticOptions& options, double off_wall, World* world);

/// Replaces what is on the part `share` of the walls that have an `alike_wall`,
/// from their origin along u, by what is there on that one.
void MakeWallsAlike(double share, World* world);

}  // namespace lowlap
