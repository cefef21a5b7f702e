#include "lowlap/study/internal/look_alikes/places.h"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/study/internal/look_alikes/rendering.h"

namespace lowlap {
namespace {

// Draws stand in braces: within parentheses every compiler has its own order.

constexpr int kWidthPx = 800;
constexpr int kHeightPx = 600;
constexpr double kFocalPx = 640;
constexpr double kNoise = 2;  // of 255 greys

struct Place {
  std::vector<Surface> surfaces;
  double width_m = 0;  // along x; the photographers stand at y < 0
  double depth_m = 0;
  double height_m = 0;
};

struct Camera {
  Vec3 center_in_world;
  Vec3 target_in_world;
};

RigidTransform PoseOf(const Camera& camera) {
  const Vec3 forward =
      (camera.target_in_world - camera.center_in_world).normalized();
  const Vec3 right = forward.cross(Vec3::UnitZ()).normalized();
  Mat3 cam_from_world;
  cam_from_world << right.transpose(), forward.cross(right).transpose(),
      forward.transpose();
  return RigidTransform::FromRotationAndCenter(cam_from_world,
                                               camera.center_in_world);
}

TonePatch PatchWithin(const Vec2& corner_m, const Vec2& size_m,
                      Random* random) {
  TonePatch patch;
  const Vec2 low{random->Uniform(0, 0.7), random->Uniform(0, 0.7)};
  const Vec2 share{random->Uniform(0.1, 0.3), random->Uniform(0.1, 0.3)};
  patch.corner_m = corner_m + low.cwiseProduct(size_m);
  patch.size_m = share.cwiseProduct(size_m);
  patch.tone = random->Uniform(0.1, 0.9);
  return patch;
}

void AddPatches(std::uint32_t most, const Vec2& corner_m, const Vec2& size_m,
                Random* random, Texture* texture) {
  const std::uint32_t count = random->Index(most + 1);
  for (std::uint32_t n = 0; n < count; ++n) {
    texture->cell.push_back(PatchWithin(corner_m, size_m, random));
  }
}

// Grout around a tile that is plain or has a pattern.
void PaintTile(Random* random, Texture* texture) {
  const double side_m = random->Uniform(0.2, 0.6);
  const double grout_m = random->Uniform(0.008, 0.02);
  texture->cell_m = Vec2(side_m, side_m);
  const double tone = random->Uniform(0.1, 0.5);
  texture->cell.push_back({Vec2::Zero(), Vec2(side_m, grout_m), tone});
  texture->cell.push_back({Vec2::Zero(), Vec2(grout_m, side_m), tone});
  AddPatches(6, Vec2::Zero(), texture->cell_m, random, texture);
}

// A frame, panes in it, and what else is the same at every window.
void PaintWindow(Random* random, Texture* texture) {
  texture->cell_m = Vec2{random->Uniform(2, 4), random->Uniform(2.8, 3.6)};
  const Vec2 size{random->Uniform(1, 1.6), random->Uniform(1.2, 2)};
  const Vec2 corner = 0.5 * (texture->cell_m - size);
  texture->cell.push_back({corner, size, random->Uniform(0.75, 0.95)});
  const std::uint32_t columns = 1 + random->Index(3);
  const std::uint32_t rows = 1 + random->Index(3);
  const Vec2 step(size.x() / columns, size.y() / rows);
  const double pane_tone = random->Uniform(0.1, 0.35);
  for (std::uint32_t pane = 0; pane < columns * rows; ++pane) {
    const Vec2 at(pane % columns, pane / columns);
    texture->cell.push_back({corner + step.cwiseProduct(at + Vec2(0.08, 0.08)),
                             0.84 * step, pane_tone});
  }
  AddPatches(4, corner, size, random, texture);
}

// A board with goods of one kind on it.
void PaintShelf(Random* random, Texture* texture) {
  texture->cell_m = Vec2{random->Uniform(0.12, 0.3), random->Uniform(0.3, 0.5)};
  const Vec2& cell = texture->cell_m;
  texture->cell.push_back(
      {Vec2::Zero(), Vec2(cell.x(), 0.03), random->Uniform(0.2, 0.5)});
  const Vec2 corner(0.1 * cell.x(), 0.03);
  const Vec2 size(0.8 * cell.x(), random->Uniform(0.5, 0.85) * cell.y());
  texture->cell.push_back({corner, size, random->Uniform(0.2, 0.9)});
  AddPatches(8, corner, size, random, texture);
}

Texture RepeatedTexture(RepeatedKind kind, Random* random) {
  Texture texture;
  texture.tone = random->Uniform(0.5, 0.8);
  switch (kind) {
    case RepeatedKind::kTiles:
      PaintTile(random, &texture);
      break;
    case RepeatedKind::kWindows:
      PaintWindow(random, &texture);
      break;
    case RepeatedKind::kShelves:
      PaintShelf(random, &texture);
      break;
  }
  return texture;
}

void HangPosters(std::uint32_t most, Random* random, Surface* surface) {
  const std::uint32_t count = random->Index(most + 1);
  for (std::uint32_t n = 0; n < count; ++n) {
    Poster poster;
    poster.size_m = Vec2{random->Uniform(0.3, 1.0), random->Uniform(0.3, 1.0)};
    poster.corner_m =
        Vec2{random->Uniform(0, surface->size_m.x() - poster.size_m.x()),
             random->Uniform(0, surface->size_m.y() - poster.size_m.y())};
    poster.seed = random->NextBits();
    surface->texture.posters.push_back(poster);
  }
}

Place MakePlace(RepeatedKind kind, const Texture& repeated, Random* random) {
  Place place;
  const bool is_outdoors = kind == RepeatedKind::kWindows;
  place.width_m = is_outdoors ? 60 : random->Uniform(5, 9);
  place.depth_m = is_outdoors ? 30 : random->Uniform(5, 9);
  place.height_m = is_outdoors ? random->Uniform(9, 15) : 2.7;
  const double w = place.width_m, d = place.depth_m, h = place.height_m;
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  place.surfaces = {{Vec3(0, -d, 0), x, y, Vec2(w, d), {}},
                    {Vec3(0, 0, 0), x, z, Vec2(w, h), {}}};
  if (!is_outdoors) {
    place.surfaces.push_back({Vec3(0, -d, 0), y, z, Vec2(d, h), {}});
    place.surfaces.push_back({Vec3(w, -d, 0), y, z, Vec2(d, h), {}});
    place.surfaces.push_back({Vec3(0, -d, 0), x, z, Vec2(w, h), {}});
  }
  const std::size_t repeats = kind == RepeatedKind::kTiles ? 0 : 1;
  for (std::size_t n = 0; n < place.surfaces.size(); ++n) {
    Surface& surface = place.surfaces[n];
    surface.texture.tone = random->Uniform(0.4, 0.9);
    surface.texture.grain = is_outdoors ? 0.3 : 0.02;
    if (n == repeats) {
      surface.texture = repeated;
      surface.texture.grain = 0.02;
      surface.texture.cell_origin_m =
          Vec2{random->Uniform(), random->Uniform()}.cwiseProduct(
              repeated.cell_m);
    }
    surface.texture.grain_seed = random->NextBits();
    HangPosters(n == repeats ? 1 : 3, random, &surface);
  }
  return place;
}

Camera DrawCamera(RepeatedKind kind, const Place& place, Random* random) {
  Camera camera;
  const double w = place.width_m, d = place.depth_m;
  const double along_m = random->Uniform(0.3 * w, 0.7 * w);
  switch (kind) {
    case RepeatedKind::kTiles:
      camera.center_in_world =
          Vec3{along_m, random->Uniform(-0.9 * d, -0.7 * d),
               random->Uniform(1.3, 1.7)};
      camera.target_in_world =
          Vec3{along_m + random->Uniform(-1, 1),
               camera.center_in_world.y() + random->Uniform(1.5, 3), 0.3};
      break;
    case RepeatedKind::kWindows:
      camera.center_in_world = Vec3(along_m, random->Uniform(-14, -8), 1.6);
      camera.target_in_world =
          Vec3{along_m + random->Uniform(-5, 5), 0, random->Uniform(2.5, 5)};
      break;
    case RepeatedKind::kShelves:
      camera.center_in_world = Vec3(along_m, random->Uniform(-3, -1.5), 1.5);
      camera.target_in_world = Vec3{along_m + random->Uniform(-0.8, 0.8), 0,
                                    random->Uniform(1, 1.5)};
      break;
  }
  return camera;
}

// A step aside, with most of what was in view.
Camera StepAside(const Camera& camera, Random* random) {
  const Vec3 ahead = camera.target_in_world - camera.center_in_world;
  const double reach_m = ahead.norm();
  Camera moved = camera;
  const double side = random->Index(2) == 0 ? -1 : 1;
  moved.center_in_world +=
      reach_m * Vec3{side * random->Uniform(0.1, 0.3),
                     random->Uniform(-0.05, 0.1), random->Uniform(-0.03, 0.03)};
  moved.target_in_world += reach_m * Vec3(random->Uniform(-0.1, 0.1), 0, 0);
  return moved;
}

}  // namespace

const char* RepeatedKindName(RepeatedKind kind) {
  switch (kind) {
    case RepeatedKind::kTiles:
      return "tiles";
    case RepeatedKind::kWindows:
      return "windows";
    case RepeatedKind::kShelves:
      return "shelves";
  }
  return "unknown";
}

std::optional<RepeatedKind> RepeatedKindFromName(const std::string& name) {
  for (const RepeatedKind kind : kRepeatedKinds) {
    if (name == RepeatedKindName(kind)) return kind;
  }
  return std::nullopt;
}

PhotographPair MakePhotographPair(RepeatedKind kind, bool is_same_place,
                                  std::uint64_t seed) {
  PhotographPair pair;
  pair.is_same_place = is_same_place;
  pair.intrinsic.width_px = kWidthPx;
  pair.intrinsic.height_px = kHeightPx;
  pair.intrinsic.fx_px = pair.intrinsic.fy_px = kFocalPx;
  pair.intrinsic.principal_point_px = 0.5 * Vec2(kWidthPx - 1, kHeightPx - 1);
  Random pattern(seed, 0), first(seed, 1), second(seed, 2);
  const Texture repeated = RepeatedTexture(kind, &pattern);
  const Place place = MakePlace(kind, repeated, &first);
  const Camera camera1 = DrawCamera(kind, place, &first);
  const RigidTransform cam1_from_world = PoseOf(camera1);
  pair.images[0] =
      Render(place.surfaces, pair.intrinsic, cam1_from_world, kNoise, &first);
  if (is_same_place) {
    const RigidTransform cam2_from_world = PoseOf(StepAside(camera1, &second));
    pair.cam2_from_cam1 = cam2_from_world * cam1_from_world.Inverse();
    pair.images[1] = Render(place.surfaces, pair.intrinsic, cam2_from_world,
                            kNoise, &second);
    return pair;
  }
  const Place elsewhere = MakePlace(kind, repeated, &second);
  pair.images[1] =
      Render(elsewhere.surfaces, pair.intrinsic,
             PoseOf(DrawCamera(kind, elsewhere, &second)), kNoise, &second);
  return pair;
}

}  // namespace lowlap
