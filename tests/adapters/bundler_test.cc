// Bundler, VisualSFM (NVM) and Bundle Adjustment in the Large.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "adapters/temporary_folder.h"
#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/format.h"
#include "lowlap/geometry/internal/rotation.h"
#include "scene/example_scenes.h"
#include "support/matchers.h"
#include "third_party_adapters/bundler/internal/bal.h"
#include "third_party_adapters/bundler/internal/bundle.h"
#include "third_party_adapters/bundler/internal/nvm.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::bundler {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::IsError;
using testing::IsOk;
using ::testing::Not;
using testing::VectorNear;

const Vec3 kAngleAxis(0.1, -0.2, 0.3);
const Vec3 kTranslation(0.4, 0.5, -6);
const Vec3 kPoint(0.7, -0.3, 0.2);
constexpr double kFocalPx = 700, kK1 = -0.08, kK2 = 0.02;

/// Where Bundler's own formula puts the point, y up.
Vec2 BundlerProjection() {
  const Vec3 x = RotationFromAngleAxis(kAngleAxis) * kPoint + kTranslation;
  const Vec2 p = -x.head<2>() / x.z();
  const double r2 = p.squaredNorm();
  return kFocalPx * (1 + kK1 * r2 + kK2 * r2 * r2) * p;
}

std::string Numbers(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) text += Format("%.17g\n", number);
  return text;
}

/// Two views of one point, by the same camera.
std::string BundleText() {
  const Mat3 r = RotationFromAngleAxis(kAngleAxis);
  const Vec2 p = BundlerProjection();
  std::string camera = Numbers({kFocalPx, kK1, kK2});
  for (int row = 0; row < 3; ++row) {
    camera += Numbers({r(row, 0), r(row, 1), r(row, 2)});
  }
  camera += Numbers({kTranslation[0], kTranslation[1], kTranslation[2]});
  const std::string xy = Numbers({p.x(), p.y()});
  return "# Bundle file v0.3\n2 1\n" + camera + camera +
         Numbers({kPoint[0], kPoint[1], kPoint[2]}) + "255 255 255\n2 0 7 " +
         xy + " 1 -1 " + xy;
}

std::string BalText() {
  const Vec2 p = BundlerProjection();
  const std::string xy = Format("%.17g %.17g\n", p.x(), p.y());
  const std::string camera =
      Numbers({kAngleAxis[0], kAngleAxis[1], kAngleAxis[2], kTranslation[0],
               kTranslation[1], kTranslation[2], kFocalPx, kK1, kK2});
  return "2 1 2\n0 0 " + xy + "1 0 " + xy + camera + camera +
         Numbers({kPoint[0], kPoint[1], kPoint[2]});
}

void ExpectReprojects(const Scene& scene) {
  ASSERT_EQ(scene.structure.size(), 1u);
  const Landmark& landmark = scene.structure.at(0);
  EXPECT_EQ(landmark.position, kPoint);
  ASSERT_EQ(landmark.observations.size(), 2u);
  for (const PointObservation& observation : landmark.observations) {
    const Vec3 in_cam =
        scene.FindPose(observation.view)->CamFromWorld() * landmark.position;
    EXPECT_GT(in_cam.z(), 0);  // in front, not mirrored
    EXPECT_THAT(scene.FindIntrinsic(observation.view)->Project(in_cam),
                VectorNear(observation.pixel_px, 1e-9));
  }
}

TEST(Bundler, AFileReprojectsAsItsFormulaSays) {
  SceneNotes notes;
  const auto model = ParseBundle(BundleText(), "a.out");
  ASSERT_THAT(model, IsOk());
  const Scene scene = *SceneFromModel(*model, &notes);
  ExpectReprojects(scene);
  EXPECT_EQ(scene.structure.at(0).observations[0].feature, 7u);
  EXPECT_EQ(scene.structure.at(0).observations[1].feature, kInvalidId);
  // In the middle of an image that has room for the observation.
  const Intrinsic& intrinsic = scene.intrinsics.at(0);
  EXPECT_EQ(
      intrinsic.principal_point_px,
      Vec2((intrinsic.width_px - 1) / 2.0, (intrinsic.height_px - 1) / 2.0));
  EXPECT_LT(BundlerProjection().cwiseAbs().x(),
            intrinsic.principal_point_px.x() + 1);
  EXPECT_THAT(notes, Contains(HasSubstr("image sizes are not in the file")));
}

TEST(Bal, AFileReprojectsAsItsFormulaSays) {
  SceneNotes notes;
  const auto model = ParseBal(BalText(), "a.bal");
  ASSERT_THAT(model, IsOk());
  ExpectReprojects(*SceneFromModel(*model, &notes));
}

TEST(Nvm, AFileIsUndistortedAsItsFormulaSays) {
  const std::string text =
      "NVM_V3 \n\n2\n"
      "a.jpg\t500 1 0 0 0 0.5 0 0 -0.05 0\n"
      "b.jpg\t500 0.8 0 0.6 0 1 2 3 0 0\n\n"
      "1\n1 2 3 255 0 0 2 0 4 100 -50 1 5 -10 20\n\n0\n# and more";
  SceneNotes notes;
  const auto model = ParseNvm(text, "a.nvm", &notes);
  ASSERT_THAT(model, IsOk());
  const Scene scene = *SceneFromModel(*model, &notes);
  EXPECT_EQ(scene.views.at(1).filename, "b.jpg");
  EXPECT_EQ(scene.poses.at(0).center, Vec3(0.5, 0, 0));
  // A turn about y; the camera's z axis in the world.
  EXPECT_THAT(Vec3(scene.poses.at(1).rotation.row(2)),
              VectorNear(Vec3(-0.96, 0, 0.28), 1e-12));
  const auto& seen = scene.structure.at(0).observations;
  const Vec2 measured(0.2, -0.1);
  EXPECT_THAT(*scene.intrinsics.at(0).Normalize(seen[0].pixel_px),
              VectorNear(Vec2(measured * (1 - 0.05 * 0.05)), 1e-9));
  EXPECT_THAT(*scene.intrinsics.at(1).Normalize(seen[1].pixel_px),
              VectorNear(Vec2(-0.02, 0.04), 1e-12));
  EXPECT_THAT(notes, Contains("1 colours of points were left out"));
}

constexpr double kNvmFocalPx = 1000;

/// Two views with distortion d of points up to 0.8 focal lengths off the axis.
std::string DistortedNvm(double d) {
  const auto camera = [&](const char* name, int x) {
    return Format("%s %g 1 0 0 0 %d 0 0 %.17g 0\n", name, kNvmFocalPx, x, d);
  };
  std::string points;
  int num_points = 0;
  for (const double radius_px : {200, 400, 500, 600, 700, 750, 800}) {
    for (int turn = 0; turn < 8; ++turn, ++num_points) {
      const Vec2 xy = radius_px * Vec2(std::cos(turn), std::sin(turn));
      points +=
          Format("1 2 3 255 255 255 2 0 %d %.17g %.17g 1 %d %.17g %.17g\n",
                 num_points, xy.x(), xy.y(), num_points, -xy.y(), xy.x());
    }
  }
  return "NVM_V3\n2\n" + camera("a.jpg", 0) + camera("b.jpg", 1) +
         std::to_string(num_points) + "\n" + points + "0\n";
}

/// The largest distance between a measurement and where its camera images what
/// NVM's formula says it shows, and the largest between that and what the
/// camera says.
Vec2 ErrorsOfUndistortion(const Scene& scene, double d) {
  Vec2 errors_px = Vec2::Zero();
  for (const auto& [id, landmark] : scene.structure) {
    for (const PointObservation& seen : landmark.observations) {
      const Intrinsic& intrinsic = *scene.FindIntrinsic(seen.view);
      const Vec2 measured =
          (seen.pixel_px - intrinsic.principal_point_px) / kNvmFocalPx;
      const Vec2 shown = measured * (1 + d * measured.squaredNorm());
      const auto normalized = intrinsic.Normalize(seen.pixel_px);
      if (!normalized) return Vec2::Constant(1e9);
      errors_px = errors_px.cwiseMax(
          Vec2((intrinsic.Project(shown.homogeneous()) - seen.pixel_px).norm(),
               kNvmFocalPx * (*normalized - shown).norm()));
    }
  }
  return errors_px;
}

TEST(Nvm, DistortionHoldsAsFarOutAsPointsAreMeasured) {
  const TemporaryFolder folder;
  struct Case {
    double d, max_error_px;
    bool is_noted;
  };
  for (const auto& [d, max_error_px, is_noted] :
       {Case{0, 1e-9, false}, Case{0.05, 0.001, false}, Case{0.1, 0.02, true},
        Case{0.2, 0.3, true}, Case{-0.1, 0.03, true}}) {
    SceneNotes notes;
    const auto scene =
        ReadScene(folder.Write("a.nvm", DistortedNvm(d)), &notes);
    ASSERT_THAT(scene, IsOk());
    const Vec2 errors_px = ErrorsOfUndistortion(*scene, d);
    EXPECT_LT(errors_px.maxCoeff(), max_error_px) << d;
    const auto has_note =
        Contains(HasSubstr("2 distortions were approximated by k1, k2, k3"));
    if (is_noted) {
      EXPECT_THAT(notes, has_note) << d;
    } else {
      EXPECT_THAT(notes, Not(has_note)) << d;
    }
  }
}

TEST(Nvm, DistortionThatCannotBeInvertedWellIsRefused) {
  const TemporaryFolder folder;
  // Off by pixels, and folded before the outermost points.
  for (const double d : {0.6, -0.6}) {
    EXPECT_THAT(
        ReadScene(folder.Write("a.nvm", DistortedNvm(d))),
        IsError(ErrorCode::kUnsupported, "a.nvm: camera 0, image 'a.jpg': "));
  }
}

TEST(Nvm, DistortionIsWrittenAsItWasRead) {
  const TemporaryFolder folder;
  for (const double d : {0.1, -0.1}) {
    Scene scene = *ReadScene(folder.Write("a.nvm", DistortedNvm(d)));
    // Whatever becomes of the points.
    for (PointTrackId id = 20; id < 56; ++id) scene.structure.erase(id);
    const std::string path = folder.Path("b.nvm");
    const auto notes = WriteScene(scene, path);
    ASSERT_THAT(notes, IsOk());
    EXPECT_THAT(*notes, Not(Contains(HasSubstr("approximated"))));
    SceneNotes ignored;
    const auto model = ParseNvm(*ReadWholeFile(path), path, &ignored);
    ASSERT_THAT(model, IsOk());
    EXPECT_EQ(model->cameras[1].camera.k[0], d);
  }
}

TEST(Nvm, AMatrixAndATranslationAreTheSameAsAQuaternionAndACentre) {
  SceneNotes notes;
  const auto model = ParseNvm(
      "NVM_V3_R9T\n1\nb.jpg 500 0.28 0 0.96 0 1 0 -0.96 0 0.28 1 2 3 0 0\n0\n",
      "a.nvm", &notes);
  ASSERT_THAT(model, IsOk());
  const Pose& pose = *model->cameras[0].pose;
  EXPECT_THAT(pose.CamFromWorld().translation, VectorNear(Vec3(1, 2, 3), 1e-9));
  EXPECT_DOUBLE_EQ(pose.rotation(0, 2), 0.96);
}

TEST(Nvm, PixelsFromTheCornerNeedAPrincipalPoint) {
  const std::string rest =
      "\n2\na.jpg 500 1 0 0 0 0 0 0 0 0\nb.jpg 500 1 0 0 0 1 0 0 0 0\n"
      "1\n1 2 3 255 255 255 2 0 4 100 50 1 5 10 20\n0\n";
  SceneNotes notes;
  EXPECT_THAT(ParseNvm("NVM_V3" + rest, "a.nvm", &notes),
              IsError(ErrorCode::kUnsupported, "a.nvm"));
  const auto model =
      ParseNvm("NVM_V3 FixedK 510 320 490 240 0" + rest, "a.nvm", &notes);
  ASSERT_THAT(model, IsOk());
  const Scene scene = *SceneFromModel(*model, &notes);
  EXPECT_EQ(scene.structure.at(0).observations[0].pixel_px, Vec2(100, 50));
  EXPECT_EQ(scene.intrinsics.at(0).principal_point_px, Vec2(320, 240));
  EXPECT_EQ(scene.intrinsics.at(0).fx_px, 510);
  EXPECT_EQ(scene.intrinsics.at(0).fy_px, 490);
  EXPECT_EQ(scene.intrinsics.at(0).width_px, 641);
}

Intrinsic Distorted(CameraModel model, std::vector<double> coefficients) {
  Intrinsic intrinsic;
  intrinsic.model = model;
  intrinsic.width_px = 1000;
  intrinsic.height_px = 800;
  intrinsic.fx_px = intrinsic.fy_px = 900;
  intrinsic.principal_point_px = {480, 410};
  intrinsic.distortion = std::move(coefficients);
  return intrinsic;
}

TEST(RadialCamera, IsExactWhereItCanBe) {
  for (const auto& [form, intrinsic] :
       {std::pair{RadialForm::kDistorts,
                  Distorted(CameraModel::kRadialK3, {-0.2, 0.1, 0})},
        std::pair{
            RadialForm::kUndistorts,
            IntrinsicFromRadial({900, {0.07, 0}}, RadialForm::kUndistorts, 0.7)
                .intrinsic}}) {
    const auto fit = RadialFromIntrinsic(intrinsic, form);
    ASSERT_THAT(fit, IsOk());
    EXPECT_EQ(fit->error_px, 0);
    EXPECT_EQ(IntrinsicFromRadial(fit->camera, form, 0.7).intrinsic.distortion,
              intrinsic.distortion);
  }
  const auto k1 = RadialFromIntrinsic(Distorted(CameraModel::kRadialK1, {-0.2}),
                                      RadialForm::kDistorts);
  EXPECT_EQ(k1->camera.k[0], -0.2);
}

TEST(RadialCamera, SaysHowWellItApproximates) {
  const auto fit = RadialFromIntrinsic(
      Distorted(CameraModel::kRadialK3, {-0.1, 0.02, -0.01}),
      RadialForm::kDistorts);
  ASSERT_THAT(fit, IsOk());
  EXPECT_GT(fit->error_px, 0);
  EXPECT_LT(fit->error_px, 0.2);
  const auto undistorts = RadialFromIntrinsic(
      Distorted(CameraModel::kRadialK1, {-0.05}), RadialForm::kUndistorts);
  ASSERT_THAT(undistorts, IsOk());
  EXPECT_NEAR(undistorts->camera.k[0], 0.05, 0.01);
  EXPECT_LT(undistorts->error_px, 0.7);
}

TEST(RadialCamera, TakesTheMeanOfTwoFocalLengths) {
  Intrinsic intrinsic = Distorted(CameraModel::kPinhole, {});
  intrinsic.fx_px = 901;
  const auto fit = RadialFromIntrinsic(intrinsic, RadialForm::kDistorts);
  ASSERT_THAT(fit, IsOk());
  EXPECT_DOUBLE_EQ(fit->camera.focal_px, std::sqrt(900.0 * 901.0));
  EXPECT_EQ(fit->camera.k[0], 0);
  // Half a pixel in 900, at the corners 520 and 410 px from the middle.
  EXPECT_NEAR(fit->error_px, 0.5 / 900 * std::hypot(520, 410), 1e-3);
}

TEST(RadialCamera, RefusesWhatItCannotHold) {
  for (const Intrinsic& intrinsic :
       {Distorted(CameraModel::kFisheye, {0, 0, 0, 0}),
        Distorted(CameraModel::kBrownT2, {0, 0, 0, 0.01, 0}),
        Distorted(CameraModel::kSpherical, {})}) {
    EXPECT_THAT(
        RadialFromIntrinsic(intrinsic, RadialForm::kUndistorts),
        IsError(ErrorCode::kUnsupported, CameraModelName(intrinsic.model)));
  }
  Intrinsic wide = Distorted(CameraModel::kPinhole, {});
  wide.fy_px = 950;
  EXPECT_FALSE(RadialFromIntrinsic(wide, RadialForm::kDistorts));
}

TEST(Bundler, ViewsThatAreNotSolvedAreEmptyCamerasWithNames) {
  const TemporaryFolder folder;
  Scene scene = testing::RandomScene(1, 4, 20, 0);
  scene.poses.erase(1);
  const std::string path = folder.Path("s.bundle.out");
  ASSERT_THAT(WriteScene(scene, path), IsOk());
  EXPECT_TRUE(std::filesystem::exists(folder.Path("s.list.txt")));
  const Scene back = *ReadScene(path);
  EXPECT_EQ(back.views.size(), 4u);
  EXPECT_EQ(back.views.at(3).filename, "3.jpg");
  EXPECT_EQ(back.FindPose(1), nullptr);
  EXPECT_EQ(back.poses.size(), 3u);
}

// Places in the list do not tell ids where views are left out.
TEST(Nvm, ImagesWithoutNamesAreNamedByTheirViews) {
  const TemporaryFolder folder;
  Scene scene = testing::RandomScene(1, 4, 20, 0);
  for (auto& [id, view] : scene.views) view.filename.clear();
  scene.poses.erase(1);
  const std::string path = folder.Path("s.nvm");
  ASSERT_THAT(WriteScene(scene, path), IsOk());
  const Scene back = *ReadScene(path);
  EXPECT_EQ(back.views.size(), 3u);
  EXPECT_EQ(back.views.at(1).filename, "image2");
}

TEST(Bundler, NamesAreInAListBesideTheFile) {
  const TemporaryFolder folder;
  const std::string path = folder.Write("bundle.out", BundleText());
  folder.Write("list.txt", "images/a.jpg 0 700\nb.jpg\n");
  EXPECT_EQ(ReadScene(path)->views.at(0).filename, "images/a.jpg");
  folder.Write("list.txt", "a.jpg\nb.jpg\nc.jpg\n");
  EXPECT_THAT(ReadScene(path), IsError(ErrorCode::kInvalidScene, "list.txt"));
  folder.Write("list.txt", "a.jpg 0 wide\n");
  EXPECT_THAT(ReadScene(path), IsError(ErrorCode::kParse, "list.txt: line 1"));
}

TEST(Bundler, ANameWithABlankIsRefusedAndNothingIsWritten) {
  const TemporaryFolder folder;
  Scene scene = testing::RandomScene(1, 3, 20, 0);
  scene.views.at(2).filename = "my photo.jpg";
  for (const char* name : {"a.out", "a.nvm"}) {
    EXPECT_THAT(WriteScene(scene, folder.Path(name)),
                IsError(ErrorCode::kUnsupported, "my photo.jpg"));
    EXPECT_FALSE(std::filesystem::exists(folder.Path(name)));
  }
}

TEST(Bundler, ObservationsBeyondAnyImageAreRefused) {
  SceneNotes notes;
  CenteredModel model = *ParseBundle(BundleText(), {});
  model.points[0].observations[1].offset_px.x() = 1e300;
  EXPECT_THAT(SceneFromModel(model, &notes),
              IsError(ErrorCode::kInvalidScene, "camera 1"));
}

/// The text up to its n-th word.
std::vector<std::string> CutsBetweenWords(const std::string& text) {
  std::vector<std::string> cuts;
  for (std::size_t n = 1; n < text.size(); ++n) {
    if (std::isspace(text[n]) && !std::isspace(text[n - 1])) {
      cuts.push_back(text.substr(0, n));
    }
  }
  return cuts;
}

TEST(Bundler, EveryTruncationIsAnErrorWithItsLine) {
  const std::string text = BundleText();
  for (const std::string& cut : CutsBetweenWords(text)) {
    if (cut.size() + 1 >= text.size()) break;
    EXPECT_THAT(ParseBundle(cut, "a.out"),
                IsError(ErrorCode::kParse, "a.out: line "));
  }
}

TEST(Bal, EveryTruncationIsAnErrorWithItsLine) {
  const std::string text = BalText();
  for (const std::string& cut : CutsBetweenWords(text)) {
    if (cut.size() + 1 >= text.size()) break;
    EXPECT_THAT(ParseBal(cut, "a.bal"),
                IsError(ErrorCode::kParse, "a.bal: line "));
  }
}

TEST(Nvm, EveryTruncationIsAnErrorWithItsLine) {
  const std::string text =
      "NVM_V3\n1\na.jpg 500 1 0 0 0 0 0 0 0 0\n"
      "1\n1 2 3 255 255 255 1 0 4 -100 50\n";
  SceneNotes notes;
  for (const std::string& cut : CutsBetweenWords(text)) {
    if (cut.size() + 1 >= text.size()) break;
    EXPECT_THAT(ParseNvm(cut, "a.nvm", &notes),
                IsError(ErrorCode::kParse, "a.nvm: line "));
  }
  EXPECT_THAT(ParseNvm(text, "a.nvm", &notes), IsOk());
}

struct BadText {
  std::string text;
  std::string message;
};

TEST(Bundler, MalformedFilesAreErrorsWithALine) {
  const std::string camera = "700 0 0 1 0 0 0 1 0 0 0 1 0 0 0\n";
  for (const BadText& bad : std::vector<BadText>{
           {"# Bundle file v0.3\nfew 1\n", "line 2: 'few' is not the number"},
           {"-1 0\n", "'-1' is not the number of cameras"},
           {"99999999999 0\n", "'99999999999' is not"},
           {"4000000000 4000000000\n" + camera, "line 3: the file ends"},
           {"1 0\n700 0 0 2 0 0 0 1 0 0 0 1 0 0 0\n", "no rotation"},
           {"1 0\n700 0 0 nan 0 0 0 1 0 0 0 1 0 0 0\n", "'nan' is not"},
           {"1 0\n-700 0 0 1 0 0 0 1 0 0 0 1 0 0 0\n", "is not positive"},
           {"1 1\n" + camera + "0 0 0 1 2 3 4000000000 0 0 1 1\n",
            "the file ends"},
           {"1 1\n" + camera + "0 0 0 1 2 3 1 1 0 1 1\n", "no camera 1"},
           {"1 1\n" + camera + "0 0 0 1 2 3 1 -1 0 1 1\n", "'-1' is not"},
           {"1 1\n" + camera + "0 0 0 1 2 3 1 0 -2 1 1\n", "no feature -2"},
           {"1 1\n" + camera + "0 0 0 1 2 3 1 0 0 inf 1\n", "'inf' is not"},
           {"1 0\n" + camera + "5\n", "line 3: more than the points"}}) {
    EXPECT_THAT(ParseBundle(bad.text, "a.out"),
                IsError(ErrorCode::kParse, bad.message))
        << bad.text;
  }
}

TEST(Bal, MalformedFilesAreErrorsWithALine) {
  const std::string camera = "0 0 0 0 0 0 500 0 0\n";
  for (const BadText& bad : std::vector<BadText>{
           {"1 1\n", "the file ends"},
           {"1 1 99999999999999999999\n", "is not the number of observations"},
           {"1 1 18446744073709551615\n0 0 1 1\n", "line 3: "},
           {"1 1 1\n1 0 1 1\n", "line 2: there is no camera 1"},
           {"1 1 1\n0 1 1 1\n", "line 2: there is no point 1"},
           {"1 1 1\n0 -1 1 1\n", "line 2: '-1' is not"},
           {"1 1 0\n0 0 0 0 0 0 0 0 0\n1 2 3\n", "is not positive"},
           {"1 1 0\n" + camera + "1 2 3 4\n", "line 3: more than"}}) {
    EXPECT_THAT(ParseBal(bad.text, "a.bal"),
                IsError(ErrorCode::kParse, bad.message))
        << bad.text;
  }
  EXPECT_TRUE(IsBalStart("1 1 1\n0 0 1.5 1\n0 0 0"));
  EXPECT_FALSE(IsBalStart("500 0 320\n0 500 240\n0 0 1\n"));  // a K.txt
}

TEST(Nvm, MalformedFilesAreErrorsWithALine) {
  SceneNotes notes;
  for (const BadText& bad : std::vector<BadText>{
           {"NVM_V2\n1\n", "NVM_V3"},
           {"NVM_V3 fixed\n1\n", "FixedK"},
           {"NVM_V3 FixedK 0 1 0 1 0\n0\n0\n", "not positive"},
           {"NVM_V3\n1\na.jpg 500 0 0 0 0 0 0 0 0 0\n0\n", "length 1"},
           {"NVM_V3\n1\na.jpg 0 1 0 0 0 0 0 0 0 0\n0\n", "'a.jpg' is not pos"},
           {"NVM_V3\n1\na.jpg 500 1 0 0 0 0 0 0 0 0\n1\n"
            "1 2 3 0 0 0 1 1 0 5 5\n",
            "line 5: there is no camera 1"}}) {
    EXPECT_THAT(ParseNvm(bad.text, "a.nvm", &notes),
                IsError(ErrorCode::kParse, bad.message))
        << bad.text;
  }
}

}  // namespace
}  // namespace lowlap::bundler
