#include "lowlap/evaluation/internal/line_truth.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

using Json = nlohmann::ordered_json;

Vec3 ParsePoint(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(),
          json.at(2).get<double>()};
}

TrueEdge ParseEdge(const Json& json) {
  TrueEdge edge;
  edge.name = json.value("name", "");
  if (const auto points = json.find("pts"); points != json.end()) {
    for (const Json& point : *points) {
      edge.points_in_world.push_back(ParsePoint(point));
    }
  } else {
    edge.points_in_world = {ParsePoint(json.at("p0")),
                            ParsePoint(json.at("p1"))};
  }
  for (const Json& view : json.at("views")) {
    edge.images.insert(view.at(0).get<int>());
  }
  return edge;
}

struct Piece {
  Vec2 start_px;
  Vec2 direction;
  double length_px;
};

// What of a piece lies in front of the camera, projected.
std::optional<Piece> Project(Vec3 a, Vec3 b, const Intrinsic& intrinsic) {
  constexpr double kNearestShare = 1e-2;  // depth per distance
  const double near_a = kNearestShare * a.norm();
  const double near_b = kNearestShare * b.norm();
  const double near = std::max(near_a, near_b);
  if (a.z() <= near && b.z() <= near) return std::nullopt;
  if (a.z() < near) a = b + (a - b) * ((b.z() - near) / (b.z() - a.z()));
  if (b.z() < near) b = a + (b - a) * ((a.z() - near) / (a.z() - b.z()));
  Piece piece;
  piece.start_px = intrinsic.Project(a);
  const Vec2 along = intrinsic.Project(b) - piece.start_px;
  piece.length_px = along.norm();
  if (!(piece.length_px > 1) || !along.allFinite()) return std::nullopt;
  piece.direction = along / piece.length_px;
  return piece;
}

bool LiesOn(const LineSegment& segment, const Piece& piece,
            const EdgeAssignmentRule& rule) {
  const Vec2 start = segment.start_px - piece.start_px;
  const Vec2 end = segment.end_px - piece.start_px;
  const Vec2 along = end - start;
  const double length = along.norm();
  const auto cross = [&](const Vec2& v) {
    return std::abs(piece.direction.x() * v.y() - piece.direction.y() * v.x());
  };
  if (!(cross(along) <= length * std::sin(RadFromDeg(rule.max_angle_deg))) ||
      cross(0.5 * (start + end)) > rule.max_distance_px) {
    return false;
  }
  const auto [low, high] =
      std::minmax({piece.direction.dot(start), piece.direction.dot(end)});
  const double shared = std::min(piece.length_px, high) - std::max(0.0, low);
  return shared >= rule.min_overlap * std::min(length, piece.length_px);
}

}  // namespace

Result<std::vector<TrueEdge>> ReadTrueEdges(const std::string& path) {
  LOWLAP_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(path));
  std::vector<TrueEdge> edges;
  std::string place;
  try {
    const Json json = Json::parse(text);
    for (const Json& edge : json.at("edges")) {
      place = "edge " + std::to_string(edges.size());
      edges.push_back(ParseEdge(edge));
    }
  } catch (const Json::exception& e) {
    // "[json.exception.KIND.NUMBER] message"
    const std::string message = e.what();
    const std::size_t start = message.find("] ");
    return MakeError(
        ErrorCode::kParse,
        start == std::string::npos ? message : message.substr(start + 2), path,
        place);
  }
  return edges;
}

std::optional<int> ImageNumber(const View& view) {
  const std::string name =
      view.filename.substr(view.filename.find_last_of('/') + 1);
  const std::string stem = name.substr(0, name.find_last_of('.'));
  if (stem.empty() || stem.size() > 9 ||
      stem.find_first_not_of("0123456789") != std::string::npos) {
    return std::nullopt;
  }
  return std::stoi(stem);
}

std::vector<std::set<std::size_t>> AssignEdges(
    const std::vector<LineSegment>& segments,
    const std::vector<TrueEdge>& edges, int image, const Pose& pose,
    const Intrinsic& intrinsic, const EdgeAssignmentRule& rule) {
  const RigidTransform cam_from_world = pose.CamFromWorld();
  std::vector<std::set<std::size_t>> assigned(segments.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges[e].images.count(image) == 0) continue;
    const std::vector<Vec3>& points = edges[e].points_in_world;
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      const auto piece = Project(cam_from_world * points[k],
                                 cam_from_world * points[k + 1], intrinsic);
      if (!piece) continue;
      for (std::size_t s = 0; s < segments.size(); ++s) {
        if (LiesOn(segments[s], *piece, rule)) assigned[s].insert(e);
      }
    }
  }
  return assigned;
}

}  // namespace lowlap
