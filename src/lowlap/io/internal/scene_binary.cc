#include "lowlap/io/internal/scene_binary.h"

#include <zlib.h>

#include <array>
#include <string_view>
#include <vector>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/io/internal/binary_record.h"
#include "lowlap/io/internal/byte_archive.h"
#include "lowlap/io/internal/center_covariances.h"
#include "lowlap/io/internal/scene_records.h"
#include "lowlap/io/internal/scene_version.h"
#include "lowlap/scene/validation.h"

namespace lowlap {
namespace {

// Like PNG's, the first byte is not text and the last ones show a file that was
// sent as text.
constexpr std::string_view kMagic("\x89LOWLAP\n", 8);

// In the order of the file; all are always there, and then a last one.
constexpr std::array<std::string_view, 13> kSections = {
    "ROOT", "VIEW", "INTR", "POSE", "STRU", "CTRL", "FEAT",
    "RELP", "PTRK", "LTRK", "RATI", "LINE", "COPL"};

// The sections of a version, in their order.
std::vector<std::string_view> SectionsOf(std::uint32_t version) {
  std::vector<std::string_view> sections(kSections.begin(), kSections.end());
  if (version == 3) sections.emplace_back("RATD");
  if (version >= 4) sections.emplace_back("GIVN");
  if (version >= 5) sections.emplace_back("CCOV");
  if (version >= 6) sections.emplace_back("WEAK");
  if (version >= 7) sections.emplace_back("REPT");
  if (version >= 8) sections.emplace_back("UNRE");
  return sections;
}

std::uint32_t Crc32(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      ::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

constexpr auto kVisitView = [](auto& record, auto& view) {
  record.Item(view.local_path);
  record.Item(view.filename);
  record.Item(view.width_px);
  record.Item(view.height_px);
  record.Item(view.intrinsic_id);
  record.Item(view.pose_id);
  record.Optional("center_prior", view.center_prior, [](auto& of, auto& prior) {
    of.Item(prior.weight);
    of.Item(prior.center_in_world);
  });
};

constexpr auto kVisitPose = [](auto& record, auto& pose) {
  record.Item(pose.rotation);
  record.Item(pose.center);
};

constexpr auto kVisitLandmark = [](auto& record, auto& landmark) {
  record.Item(landmark.position);
  record.List("observations", landmark.observations,
              [](auto& of, auto& observation) {
                of.Item(observation.view);
                of.Item(observation.feature);
                of.Item(observation.pixel_px);
              });
};

template <class Bytes, class SceneType>
void TransferCenterCovariances(BinaryRecord<Bytes>& record, SceneType& scene) {
  CenterCovariances covariances = CenterCovariancesOf(scene);
  record.MapById(covariances, kVisitCenterCovariance);
  if constexpr (Bytes::kReads) SetCenterCovariances(covariances, scene);
}

// One for each relative pose, in their order.
template <class Bytes, class SceneType>
void TransferWeaknesses(BinaryRecord<Bytes>& record, SceneType& scene) {
  for (auto& entry : scene.relative_poses) {
    record.Optional("weakness", entry.second.weakness);
  }
}

// One for each view of FEAT, in their order.
template <class Bytes, class SceneType>
void TransferRepeated(BinaryRecord<Bytes>& record, SceneType& scene) {
  for (auto& entry : scene.features) kVisitRepeated(record, entry.second);
}

template <class Bytes, class SceneType>
void TransferSection(std::string_view tag, Bytes& bytes, SceneType& scene) {
  BinaryRecord record(bytes);
  if (tag == "ROOT") {
    record.Item(scene.root_path);
  } else if (tag == "VIEW") {
    record.MapById(scene.views, kVisitView);
  } else if (tag == "INTR") {
    record.MapById(scene.intrinsics, kVisitIntrinsic);
  } else if (tag == "POSE") {
    record.MapById(scene.poses, kVisitPose);
  } else if (tag == "STRU") {
    record.MapById(scene.structure, kVisitLandmark);
  } else if (tag == "CTRL") {
    record.MapById(scene.control_points, kVisitLandmark);
  } else if (tag == "FEAT") {
    record.MapById(scene.features, kVisitFeatures);
  } else if (tag == "RELP") {
    record.MapByViews(scene.relative_poses, kVisitRelativePose);
  } else if (tag == "PTRK") {
    record.MapById(scene.point_tracks, kVisitTrack);
  } else if (tag == "LTRK") {
    record.MapById(scene.line_tracks, kVisitTrack);
  } else if (tag == "RATI") {
    record.List("scale_ratios", scene.scale_ratios, kVisitScaleRatio);
  } else if (tag == "LINE") {
    record.MapById(scene.line_structure, kVisitLine);
  } else if (tag == "COPL") {
    record.Flat("coplanar_pairs", scene.coplanar_pairs, kVisitPair);
  } else if (tag == "GIVN") {
    record.MapById(scene.given_intrinsics, kVisitIntrinsic);
  } else if (tag == "CCOV") {
    TransferCenterCovariances(record, scene);
  } else if (tag == "WEAK") {
    TransferWeaknesses(record, scene);
  } else if (tag == "REPT") {
    TransferRepeated(record, scene);
  } else if (tag == "UNRE") {
    record.Flat("unrelated_pairs", scene.unrelated_pairs, kVisitPair);
  }
}

// The section "RATD" of version 3: the number of scale ratios again, then the
// second mode and the shares of information of each.
void ReadOldRatioDetails(ByteReader& bytes, std::vector<ScaleRatio>& ratios) {
  if (bytes.Length(ratios.size(), 1 + 3 * 8) != ratios.size()) {
    bytes.Fail("there are not as many details as scale ratios");
  }
  BinaryRecord record(bytes);
  for (ScaleRatio& ratio : ratios) {
    record.Optional("second_mode", ratio.second_mode, kVisitRatioMode);
    for (KindSupport& support : ratio.kinds) {
      record.Item(support.information_share);
    }
  }
}

void ReadPayload(std::string_view tag, std::uint32_t version,
                 ByteReader& section, Scene& scene) {
  if (tag == "RATD") {
    ReadOldRatioDetails(section, scene.scale_ratios);
  } else if (tag == "RATI" && version < kFirstVersionWithKinds) {
    BinaryRecord(section).List("scale_ratios", scene.scale_ratios,
                               kVisitOldScaleRatio);
  } else {
    TransferSection(tag, section, scene);
  }
}

void ReadSection(std::string_view tag, std::uint32_t version, ByteReader& file,
                 std::size_t size, Scene& scene) {
  const std::string_view stored_tag = file.Take(tag.size());
  const std::string name(tag);
  if (stored_tag != tag) file.Fail("section " + name + " is missing");
  std::uint32_t checksum = 0;
  std::uint64_t length = 0;
  file.Integer(checksum);
  file.Integer(length);
  if (length > file.BytesLeft()) {
    file.Fail("section " + name + " ends early");
  }
  const std::size_t offset = size - file.BytesLeft();
  const std::string_view payload = file.Take(length);
  if (Crc32(payload) != checksum) {
    file.Fail("section " + name + " is damaged: its checksum is wrong");
  }
  ByteReader section(payload, "section " + name + ", ", offset);
  ReadPayload(tag, version, section, scene);
  if (section.BytesLeft() > 0) section.Fail("the section is too long");
}

Scene ReadSections(const std::string& bytes) {
  ByteReader file(bytes, {}, 0);
  if (file.BytesLeft() < kMagic.size() || file.Take(kMagic.size()) != kMagic) {
    file.Fail("this is not a .lowlap file");
  }
  std::uint32_t version = 0, section_count = 0;
  file.Integer(version);
  if (version < kOldestSceneVersion || version > kSceneVersion) {
    throw Failure{Error{ErrorCode::kUnsupported,
                        "version " + std::to_string(version) + " is not " +
                            std::to_string(kOldestSceneVersion) + " to " +
                            std::to_string(kSceneVersion),
                        {},
                        "byte " + std::to_string(kMagic.size())}};
  }
  file.Integer(section_count);
  const std::vector<std::string_view> sections = SectionsOf(version);
  if (section_count != sections.size()) {
    file.Fail("the number of sections is wrong");
  }
  Scene scene;
  for (const std::string_view tag : sections) {
    ReadSection(tag, version, file, bytes.size(), scene);
  }
  if (file.BytesLeft() > 0) file.Fail("something follows the last section");
  return scene;
}

template <class Unsigned>
std::string Encoded(Unsigned value) {
  std::string bytes;
  ByteWriter(bytes).Integer(value);
  return bytes;
}

}  // namespace

Result<Scene> ParseSceneBinary(const std::string& bytes,
                               const std::string& file) {
  return CaughtScene([&] { return ReadSections(bytes); }, file);
}

Result<Scene> ReadSceneBinary(const std::string& path) {
  LOWLAP_ASSIGN_OR_RETURN(const std::string bytes, ReadWholeFile(path));
  return ParseSceneBinary(bytes, path);
}

Result<std::string> FormatSceneBinary(const Scene& scene) {
  LOWLAP_RETURN_IF_ERROR(ValidateScene(scene));
  std::string bytes(kMagic);
  bytes += Encoded(kSceneVersion);
  const std::vector<std::string_view> sections = SectionsOf(kSceneVersion);
  bytes += Encoded(static_cast<std::uint32_t>(sections.size()));
  std::string payload;
  for (const std::string_view tag : sections) {
    payload.clear();
    ByteWriter writer(payload);
    TransferSection(tag, writer, scene);
    bytes += tag;
    bytes += Encoded(Crc32(payload));
    bytes += Encoded(static_cast<std::uint64_t>(payload.size()));
    bytes += payload;
  }
  return bytes;
}

}  // namespace lowlap
