#include <map>
#include <vector>

#include "lowlap/io/internal/center_covariances.h"
#include "lowlap/io/internal/json/json_record_reader.h"
#include "lowlap/io/internal/json/json_record_writer.h"
#include "lowlap/io/internal/json/scene_json_sections.h"
#include "lowlap/io/internal/scene_records.h"
#include "lowlap/io/internal/scene_version.h"

namespace lowlap {
namespace {

// In the order of the file.
template <class Sections, class SceneType, class Covariances>
void VisitSections(Sections& sections, SceneType& scene,
                   Covariances& center_covariances) {
  sections.ById("given_intrinsics", "id", scene.given_intrinsics,
                kVisitIntrinsic);
  sections.ById("center_covariances", "id", center_covariances,
                kVisitCenterCovariance);
  sections.ById("features", "view", scene.features, kVisitFeatures);
  sections.RelativePoses("relative_poses", scene.relative_poses);
  sections.Pairs("unrelated_pairs", scene.unrelated_pairs);
  sections.ById("point_tracks", "id", scene.point_tracks, kVisitTrack);
  sections.ById("line_tracks", "id", scene.line_tracks, kVisitTrack);
  sections.ScaleRatios("scale_ratios", scene.scale_ratios);
  sections.ById("line_structure", "id", scene.line_structure, kVisitLine);
  sections.Pairs("coplanar_pairs", scene.coplanar_pairs);
}

class SectionWriter {
 public:
  explicit SectionWriter(std::string& text) : text_(text) {}

  template <class Map, class Visit>
  void ById(const char* name, const char* key, const Map& map,
            const Visit& visit) {
    Records(name, map, [&](JsonRecordWriter& record, const auto& entry) {
      record.Member(key, entry.first);
      visit(record, entry.second);
    });
  }
  void RelativePoses(const char* name,
                     const std::map<ViewPair, RelativePose>& poses) {
    Records(name, poses, [](JsonRecordWriter& record, const auto& entry) {
      kVisitRelativePose(record, entry.second);
    });
  }
  void ScaleRatios(const char* name, const std::vector<ScaleRatio>& ratios) {
    Records(name, ratios, kVisitScaleRatio);
  }
  template <class Pair>
  void Pairs(const char* name, const std::vector<Pair>& pairs) {
    text_ += ",\n";
    AppendValue(name, text_);
    text_ += ": [";
    JsonRecordWriter flat(text_);
    for (const Pair& pair : pairs) kVisitPair(flat, pair);
    text_ += "]";
  }

 private:
  template <class Items, class Visit>
  void Records(const char* name, const Items& items, const Visit& visit) {
    const auto append = [&](const auto& item, std::string& text) {
      JsonRecordWriter(text).Object(item, visit);
    };
    AppendSection(name, items, append, text_);
  }

  std::string& text_;
};

// A section that is missing is empty.
class SectionReader {
 public:
  SectionReader(const JsonValue& own, std::uint32_t version)
      : own_(own), version_(version) {}

  template <class Map, class Visit>
  void ById(const char* name, const char* key, Map& map, const Visit& visit) {
    ForEach(name, [&](const JsonValue& record) {
      typename Map::mapped_type value;
      Read(record, value, visit, key);
      Insert(map, record.At(key), std::move(value), key);
    });
  }
  void RelativePoses(const char* name,
                     std::map<ViewPair, RelativePose>& poses) {
    ForEach(name, [&](const JsonValue& record) {
      RelativePose edge;
      Read(record, edge, kVisitRelativePose);
      const ViewPair views = edge.views;
      if (!poses.emplace(views, std::move(edge)).second) {
        record.Fail("the pair of views is repeated", ErrorCode::kInvalidScene);
      }
    });
  }
  void ScaleRatios(const char* name, std::vector<ScaleRatio>& ratios) {
    ForEach(name, [&](const JsonValue& record) {
      ScaleRatio& ratio = ratios.emplace_back();
      version_ < kFirstVersionWithKinds
          ? Read(record, ratio, kVisitOldScaleRatio)
          : Read(record, ratio, kVisitScaleRatio);
    });
  }
  template <class Pair>
  void Pairs(const char* name, std::vector<Pair>& pairs) {
    if (const auto flat = own_.Find(name)) ReadFlat(*flat, kVisitPair, pairs);
  }

 private:
  template <class Take>
  void ForEach(const char* name, const Take& take) const {
    const auto list = own_.Find(name);
    if (!list) return;
    for (const JsonValue record : list->Elements()) take(record);
  }

  const JsonValue& own_;
  std::uint32_t version_;
};

}  // namespace

void ReadOwnSections(const JsonValue& own, Scene& scene) {
  const JsonValue version = own.At("version");
  if (version.Id() < kOldestSceneVersion || version.Id() > kSceneVersion) {
    version.Fail("version " + std::to_string(version.Id()) + " is not " +
                     std::to_string(kOldestSceneVersion) + " to " +
                     std::to_string(kSceneVersion),
                 ErrorCode::kUnsupported);
  }
  own.AllowOnly({"version", "given_intrinsics", "center_covariances",
                 "features", "relative_poses", "unrelated_pairs",
                 "point_tracks", "line_tracks", "scale_ratios",
                 "line_structure", "coplanar_pairs"});
  SectionReader sections(own, version.Id());
  CenterCovariances center_covariances;
  VisitSections(sections, scene, center_covariances);
  SetCenterCovariances(center_covariances, scene);
}

void AppendOwnSections(const Scene& scene, std::string& text) {
  text += "\"version\": " + std::to_string(kSceneVersion);
  SectionWriter sections(text);
  const CenterCovariances center_covariances = CenterCovariancesOf(scene);
  VisitSections(sections, scene, center_covariances);
}

}  // namespace lowlap
