// Loads our text with the library that OpenMVG loads it with: polymorphic
// pointers and all, into types that hold what OpenMVG's hold.
#include <gtest/gtest.h>

#include <cereal/archives/json.hpp>
#include <cereal/types/memory.hpp>
#include <cereal/types/polymorphic.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/unordered_map.hpp>
#include <cereal/types/vector.hpp>
#include <memory>
#include <sstream>

#include "lowlap/io/internal/json/scene_json.h"
#include "scene/example_scenes.h"
#include "support/matchers.h"

namespace {

using cereal::make_nvp;

struct HostView {
  virtual ~HostView() = default;
  std::string local_path, filename;
  std::uint32_t width, height, id_view, id_intrinsic, id_pose;

  template <class Archive>
  void serialize(Archive& archive) {
    archive(make_nvp("local_path", local_path), make_nvp("filename", filename),
            make_nvp("width", width), make_nvp("height", height),
            make_nvp("id_view", id_view),
            make_nvp("id_intrinsic", id_intrinsic),
            make_nvp("id_pose", id_pose));
  }
};

struct HostViewPriors : HostView {
  bool use_center = false;
  std::vector<double> weight, center;

  template <class Archive>
  void serialize(Archive& archive) {
    HostView::serialize(archive);
    archive(make_nvp("use_pose_center_prior", use_center),
            make_nvp("center_weight", weight), make_nvp("center", center));
  }
};

struct HostIntrinsic {
  virtual ~HostIntrinsic() = default;
  virtual std::string Name() const = 0;
  std::uint32_t width, height;

  template <class Archive>
  void serialize(Archive& archive) {
    archive(make_nvp("width", width), make_nvp("height", height));
  }
};

struct HostPinhole : HostIntrinsic {
  double focal;
  std::vector<double> principal_point;
  std::string Name() const override { return "pinhole"; }

  template <class Archive>
  void serialize(Archive& archive) {
    HostIntrinsic::serialize(archive);
    archive(make_nvp("focal_length", focal),
            make_nvp("principal_point", principal_point));
  }
};

#define DISTORTED_HOST_CAMERA(TYPE, NAME, KEY)         \
  struct TYPE : HostPinhole {                          \
    std::vector<double> distortion;                    \
    std::string Name() const override { return NAME; } \
    template <class Archive>                           \
    void serialize(Archive& archive) {                 \
      HostPinhole::serialize(archive);                 \
      archive(make_nvp(KEY, distortion));              \
    }                                                  \
  };
DISTORTED_HOST_CAMERA(HostK1, "pinhole_radial_k1", "disto_k1")
DISTORTED_HOST_CAMERA(HostK3, "pinhole_radial_k3", "disto_k3")
DISTORTED_HOST_CAMERA(HostBrown, "pinhole_brown_t2", "disto_t2")
DISTORTED_HOST_CAMERA(HostFisheye, "fisheye", "fisheye")
#undef DISTORTED_HOST_CAMERA

struct HostSpherical : HostIntrinsic {
  std::string Name() const override { return "spherical"; }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cereal::base_class<HostIntrinsic>(this));
  }
};

struct HostPose {
  std::vector<std::vector<double>> rotation;
  std::vector<double> center;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(make_nvp("rotation", rotation), make_nvp("center", center));
  }
};

struct HostObservation {
  std::uint32_t id_feat;
  std::vector<double> x;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(make_nvp("id_feat", id_feat), make_nvp("x", x));
  }
};

struct HostLandmark {
  std::vector<double> X;
  std::unordered_map<std::uint32_t, HostObservation> observations;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(make_nvp("X", X), make_nvp("observations", observations));
  }
};

template <class Value>
using HostMap = std::unordered_map<std::uint32_t, Value>;

}  // namespace

CEREAL_REGISTER_TYPE_WITH_NAME(HostViewPriors, "view_priors")
CEREAL_REGISTER_POLYMORPHIC_RELATION(HostView, HostViewPriors)
CEREAL_REGISTER_TYPE_WITH_NAME(HostPinhole, "pinhole")
CEREAL_REGISTER_POLYMORPHIC_RELATION(HostIntrinsic, HostPinhole)
CEREAL_REGISTER_TYPE_WITH_NAME(HostK1, "pinhole_radial_k1")
CEREAL_REGISTER_POLYMORPHIC_RELATION(HostIntrinsic, HostK1)
CEREAL_REGISTER_TYPE_WITH_NAME(HostK3, "pinhole_radial_k3")
CEREAL_REGISTER_POLYMORPHIC_RELATION(HostIntrinsic, HostK3)
CEREAL_REGISTER_TYPE_WITH_NAME(HostBrown, "pinhole_brown_t2")
CEREAL_REGISTER_POLYMORPHIC_RELATION(HostIntrinsic, HostBrown)
CEREAL_REGISTER_TYPE_WITH_NAME(HostFisheye, "fisheye")
CEREAL_REGISTER_POLYMORPHIC_RELATION(HostIntrinsic, HostFisheye)
CEREAL_REGISTER_TYPE_WITH_NAME(HostSpherical, "spherical")
CEREAL_REGISTER_POLYMORPHIC_RELATION(HostIntrinsic, HostSpherical)

namespace lowlap {
namespace {

TEST(SceneJson, LoadsWithCereal) {
  const Scene scene = testing::FullScene();
  const Result<std::string> text = FormatSceneJson(scene);
  ASSERT_THAT(text, testing::IsOk());

  std::istringstream stream(*text);
  cereal::JSONInputArchive archive(stream);
  std::string version, root_path;
  HostMap<std::shared_ptr<HostView>> views;
  HostMap<std::shared_ptr<HostIntrinsic>> intrinsics;
  HostMap<HostPose> extrinsics;
  HostMap<HostLandmark> structure, control_points;
  archive(make_nvp("sfm_data_version", version),
          make_nvp("root_path", root_path), make_nvp("views", views),
          make_nvp("intrinsics", intrinsics),
          make_nvp("extrinsics", extrinsics), make_nvp("structure", structure),
          make_nvp("control_points", control_points));

  EXPECT_EQ(version, "0.3");
  EXPECT_EQ(root_path, scene.root_path);
  ASSERT_EQ(views.size(), scene.views.size());
  for (const auto& [id, view] : scene.views) {
    const HostView& host = *views.at(id.value());
    EXPECT_EQ(host.id_view, id);
    EXPECT_EQ(host.filename, view.filename);
    EXPECT_EQ(host.local_path, view.local_path);
    EXPECT_EQ(host.id_intrinsic, view.intrinsic_id);
    EXPECT_EQ(host.id_pose, view.pose_id);
    const auto* priors = dynamic_cast<const HostViewPriors*>(&host);
    ASSERT_EQ(priors != nullptr, view.center_prior.has_value());
    if (!priors) continue;
    EXPECT_TRUE(priors->use_center);
    EXPECT_EQ(Vec3(priors->center.data()), view.center_prior->center_in_world);
  }
  ASSERT_EQ(intrinsics.size(), scene.intrinsics.size());
  for (const auto& [id, intrinsic] : scene.intrinsics) {
    const HostIntrinsic& host = *intrinsics.at(id.value());
    EXPECT_EQ(host.Name(), CameraModelName(intrinsic.model));
    EXPECT_EQ(host.width, static_cast<std::uint32_t>(intrinsic.width_px));
    if (const auto* pinhole = dynamic_cast<const HostPinhole*>(&host)) {
      EXPECT_DOUBLE_EQ(pinhole->focal, intrinsic.MeanFocalPx());
    }
    if (const auto* brown = dynamic_cast<const HostBrown*>(&host)) {
      EXPECT_EQ(brown->distortion, intrinsic.distortion);
    }
  }
  ASSERT_EQ(extrinsics.size(), scene.poses.size());
  for (const auto& [id, pose] : scene.poses) {
    EXPECT_EQ(Vec3(extrinsics.at(id.value()).center.data()), pose.center);
    EXPECT_EQ(extrinsics.at(id.value()).rotation.at(1).at(2),
              pose.rotation(1, 2));
  }
  ASSERT_EQ(structure.size(), scene.structure.size());
  for (const auto& [id, landmark] : scene.structure) {
    const HostLandmark& host = structure.at(id.value());
    EXPECT_EQ(Vec3(host.X.data()), landmark.position);
    ASSERT_EQ(host.observations.size(), landmark.observations.size());
    for (const PointObservation& observation : landmark.observations) {
      const HostObservation& seen =
          host.observations.at(observation.view.value());
      EXPECT_EQ(seen.id_feat, observation.feature);
      EXPECT_EQ(Vec2(seen.x.data()), observation.pixel_px);
    }
  }
  EXPECT_EQ(control_points.size(), scene.control_points.size());
}

}  // namespace
}  // namespace lowlap
