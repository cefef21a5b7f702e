#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

// The data of OpenMVG 2.1 that the engine touches: its names and types.

namespace openMVG {

using IndexT = std::uint32_t;
static const IndexT UndefinedIndexT = std::numeric_limits<IndexT>::max();
using Pair = std::pair<IndexT, IndexT>;
template <class Key, class Value>
using Hash_Map =
    std::map<Key, Value, std::less<Key>,
             Eigen::aligned_allocator<std::pair<const Key, Value>>>;
using Mat3 = Eigen::Matrix3d;
using Vec3 = Eigen::Vector3d;

namespace cameras {

enum EINTRINSIC { PINHOLE_CAMERA = 1 };

struct IntrinsicBase {
  IntrinsicBase(unsigned int w, unsigned int h) : w_(w), h_(h) {}
  virtual ~IntrinsicBase() = default;
  unsigned int w() const { return w_; }
  unsigned int h() const { return h_; }
  virtual EINTRINSIC getType() const = 0;
  virtual std::vector<double> getParams() const = 0;

  unsigned int w_, h_;
};

class Pinhole_Intrinsic : public IntrinsicBase {
 public:
  Pinhole_Intrinsic(unsigned int w, unsigned int h, double focal_length_pix,
                    double ppx, double ppy)
      : IntrinsicBase(w, h), parameters_{focal_length_pix, ppx, ppy} {}
  EINTRINSIC getType() const override { return PINHOLE_CAMERA; }
  std::vector<double> getParams() const override { return parameters_; }

 private:
  std::vector<double> parameters_;
};

}  // namespace cameras

namespace features {

class PointFeature {
 public:
  PointFeature(float x = 0, float y = 0) : coords_(x, y) {}
  float x() const { return coords_(0); }
  float y() const { return coords_(1); }

 private:
  Eigen::Vector2f coords_;
};
using PointFeatures = std::vector<PointFeature>;

}  // namespace features

namespace geometry {

class Pose3 {
 public:
  Pose3() : rotation_(Mat3::Identity()), center_(Vec3::Zero()) {}
  Pose3(const Mat3& r, const Vec3& c) : rotation_(r), center_(c) {}
  const Mat3& rotation() const { return rotation_; }
  const Vec3& center() const { return center_; }
  Vec3 translation() const { return -(rotation_ * center_); }

 private:
  Mat3 rotation_;
  Vec3 center_;
};

}  // namespace geometry

namespace matching {

struct IndMatch {
  IndMatch(IndexT i = 0, IndexT j = 0) : i_(i), j_(j) {}
  IndexT i_, j_;
};
using IndMatches = std::vector<IndMatch>;
struct PairWiseMatches : public std::map<Pair, IndMatches> {};

}  // namespace matching

namespace rotation_averaging {

struct RelativeRotation {
  IndexT i, j;
  Mat3 Rij;  // R_j = Rij R_i
  float weight;
  RelativeRotation(IndexT i_ = 0, IndexT j_ = 0,
                   const Mat3& Rij_ = Mat3::Identity(), float weight_ = 1.0f)
      : i(i_), j(j_), Rij(Rij_), weight(weight_) {}
};
using RelativeRotations = std::vector<RelativeRotation>;

}  // namespace rotation_averaging

namespace sfm {

struct View {
  std::string s_Img_path;
  IndexT id_view, id_intrinsic, id_pose, ui_width, ui_height;
  View(const std::string& image_path, IndexT view, IndexT intrinsic,
       IndexT pose, IndexT width, IndexT height)
      : s_Img_path(image_path),
        id_view(view),
        id_intrinsic(intrinsic),
        id_pose(pose),
        ui_width(width),
        ui_height(height) {}
  virtual ~View() = default;
};
using Poses = Hash_Map<IndexT, geometry::Pose3>;

struct SfM_Data {
  Hash_Map<IndexT, std::shared_ptr<View>> views;
  Poses poses;
  Hash_Map<IndexT, std::shared_ptr<cameras::IntrinsicBase>> intrinsics;
  std::string s_root_path;
  const Poses& GetPoses() const { return poses; }
};

struct Features_Provider {
  Hash_Map<IndexT, features::PointFeatures> feats_per_view;
};
struct Matches_Provider {
  matching::PairWiseMatches pairWise_matches_;
};

}  // namespace sfm
}  // namespace openMVG
