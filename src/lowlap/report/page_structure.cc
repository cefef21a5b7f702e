#include <limits>
#include <string>

#include "lowlap/report/internal/base64.h"
#include "lowlap/report/internal/page_parts.h"

namespace lowlap {
namespace {

class Positions {
 public:
  explicit Positions(const DisplayFrame& frame) : frame_(frame) {}

  void Add(const Vec3& point_in_world) { Append(frame_(point_in_world)); }
  void AddNone() {
    Append(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  }
  std::string Encoded() const { return Base64(numbers_); }

 private:
  void Append(const Vec3& shown) {
    for (int axis = 0; axis < 3; ++axis) {
      numbers_.push_back(static_cast<float>(shown(axis)));
    }
  }

  const DisplayFrame& frame_;
  std::vector<float> numbers_;
};

}  // namespace

void AddStructure(const Scene& scene, const std::optional<ReportStage>& before,
                  const PageIndex& index, const DisplayFrame& frame,
                  PageJson* page) {
  Positions points(frame), points_before(frame), lines(frame),
      lines_before(frame);
  std::vector<std::uint8_t> views_of_points, views_of_lines;
  for (const auto& [id, place] : index.points) {
    const Landmark& landmark = scene.structure.at(id);
    points.Add(landmark.position);
    views_of_points.push_back(static_cast<std::uint8_t>(
        std::min<std::size_t>(255, landmark.observations.size())));
    if (!before) continue;
    const auto earlier = before->points.find(id);
    if (earlier == before->points.end()) {
      points_before.AddNone();
    } else {
      points_before.Add(earlier->second);
    }
  }
  for (const auto& [id, line] : scene.line_structure) {
    lines.Add(line.start);
    lines.Add(line.end);
    views_of_lines.push_back(static_cast<std::uint8_t>(
        std::min<std::size_t>(255, line.observations.size())));
    if (!before) continue;
    const auto earlier = before->lines.find(id);
    for (std::size_t end = 0; end < 2; ++end) {
      if (earlier == before->lines.end()) {
        lines_before.AddNone();
      } else {
        lines_before.Add(earlier->second[end]);
      }
    }
  }
  std::vector<std::uint32_t> pairs;
  for (const CoplanarPair& pair : scene.coplanar_pairs) {
    const auto first = index.lines.find(pair.first);
    const auto second = index.lines.find(pair.second);
    if (first == index.lines.end() || second == index.lines.end()) continue;
    pairs.push_back(first->second);
    pairs.push_back(second->second);
  }
  (*page)["points"] = {{"positions", points.Encoded()},
                       {"num_views", Base64(views_of_points)}};
  (*page)["lines"] = {{"positions", lines.Encoded()},
                      {"num_views", Base64(views_of_lines)}};
  if (before) {
    (*page)["points"]["before"] = points_before.Encoded();
    (*page)["lines"]["before"] = lines_before.Encoded();
  }
  (*page)["coplanar_pairs"] = Base64(pairs);
}

}  // namespace lowlap
