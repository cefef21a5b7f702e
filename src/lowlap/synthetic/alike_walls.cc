#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "lowlap/synthetic/internal/world.h"

namespace lowlap {
namespace {

Vec3 Middle(const WorldPoint& point) { return point.position; }
Vec3 Middle(const WorldLine& line) { return 0.5 * (line.start + line.end); }

bool IsInPart(const Wall& wall, const Vec3& place, double share) {
  return wall.u.dot(place - wall.origin) < share * wall.u.squaredNorm();
}

// Features of one wall to another one of the same shape.
struct Carrier {
  const Wall& from;
  const Wall& to;
  const std::map<int, int>& plane_of;

  Vec3 operator()(const Vec3& place) const {
    const Vec3 offset = place - from.origin;
    return to.At(offset.dot(from.u) / from.u.squaredNorm(),
                 offset.dot(from.v) / from.v.squaredNorm()) +
           offset.dot(from.inward) * to.inward;
  }
  WorldPoint operator()(const WorldPoint& point) const {
    return {(*this)(point.position)};
  }
  WorldLine operator()(const WorldLine& line) const {
    WorldLine carried;
    carried.start = (*this)(line.start);
    carried.end = (*this)(line.end);
    for (const int plane : line.planes) {
      carried.planes.push_back(plane_of.at(plane));
    }
    return carried;
  }
};

template <class Feature>
std::vector<Feature> Alike(const std::vector<Wall>& walls,
                           const std::map<int, int>& plane_of, double share,
                           const std::vector<Feature>& features) {
  std::vector<Feature> alike;
  for (const Feature& feature : features) {
    const Wall& wall = walls[feature.wall];
    if (wall.alike_wall < 0 || !IsInPart(wall, Middle(feature), share)) {
      alike.push_back(feature);
    }
  }
  const std::size_t num_own = alike.size();
  for (std::size_t w = 0; w < walls.size(); ++w) {
    if (walls[w].alike_wall < 0) continue;
    const Wall& other = walls[walls[w].alike_wall];
    const Carrier carry = {other, walls[w], plane_of};
    for (std::size_t n = 0; n < num_own; ++n) {
      if (alike[n].wall != walls[w].alike_wall ||
          !IsInPart(other, Middle(alike[n]), share)) {
        continue;
      }
      Feature copy = carry(alike[n]);
      copy.wall = static_cast<int>(w);
      copy.alike = static_cast<int>(n);
      alike.push_back(std::move(copy));
    }
  }
  return alike;
}

}  // namespace

void MakeWallsAlike(double share, World* world) {
  // Both ways: the two planes of an edge are of walls of either kind.
  std::map<int, int> plane_of;
  for (const Wall& wall : world->walls) {
    if (wall.alike_wall < 0) continue;
    const Wall& other = world->walls[wall.alike_wall];
    plane_of[other.plane] = wall.plane;
    plane_of[wall.plane] = other.plane;
    plane_of[other.box_plane] = wall.box_plane;
    plane_of[wall.box_plane] = other.box_plane;
  }
  world->points = Alike(world->walls, plane_of, share, world->points);
  world->lines = Alike(world->walls, plane_of, share, world->lines);
}

}  // namespace lowlap
