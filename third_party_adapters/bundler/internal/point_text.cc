#include "third_party_adapters/bundler/internal/point_text.h"

#include "third_party_adapters/internal/number_text.h"

namespace lowlap::bundler {

CenteredPoint NextPoint(std::size_t num_cameras, double y_sign,
                        TokenReader* reader) {
  CenteredPoint point;
  point.position = NextVec3("a coordinate of a point", reader);
  point.has_color = NextVec3("a colour", reader) != Vec3::Constant(255);
  const auto count =
      reader->Next<std::uint32_t>("the number of observations of a point");
  for (std::uint32_t n = 0; n < count && reader->status(); ++n) {
    CenteredObservation observation;
    observation.camera = reader->Next<std::uint32_t>("a camera index");
    const auto feature = reader->Next<std::int64_t>("a feature index");
    const Vec2 xy = NextVec2("a coordinate of an observation", reader);
    if (!reader->status()) break;
    if (observation.camera >= num_cameras) {
      reader->Fail("there is no camera " + std::to_string(observation.camera));
    }
    if (feature < -1 || feature >= std::int64_t{kInvalidId}) {
      reader->Fail("there is no feature " + std::to_string(feature));
    }
    observation.feature = static_cast<FeatureIndex>(feature);
    observation.offset_px = {xy.x(), y_sign * xy.y()};
    point.observations.push_back(observation);
  }
  return point;
}

std::string PointText(const CenteredPoint& point, double y_sign) {
  std::string text = NumberText(point.position) + " 255 255 255 " +
                     std::to_string(point.observations.size());
  for (const CenteredObservation& observation : point.observations) {
    const std::string feature = observation.feature == kInvalidId
                                    ? "-1"
                                    : std::to_string(observation.feature);
    text += " " + std::to_string(observation.camera) + " " + feature + " " +
            NumberText(Vec2(observation.offset_px.x(),
                            y_sign * observation.offset_px.y()));
  }
  return text + "\n";
}

}  // namespace lowlap::bundler
