#pragma once

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>
#include <string>

#include "openmvg_types.h"

// The engines of OpenMVG 2.1 that the tutorial calls or derives from, with just
// enough behind them for exact matches of pinhole cameras.

namespace openMVG::sfm {

/// Essential matrices by eight points.
class Relative_Pose_Engine {
 public:
  using Relative_Pair_Poses = Hash_Map<Pair, geometry::Pose3>;

  bool Process(const SfM_Data& sfm_data, const Matches_Provider* matches,
               const Features_Provider* features) {
    for (const auto& entry : matches->pairWise_matches_) {
      const matching::IndMatches& of_pair = entry.second;
      if (of_pair.size() < 8) continue;
      const auto rays = [&](IndexT id, bool first) {
        const View& view = *sfm_data.views.at(id);
        const auto k = sfm_data.intrinsics.at(view.id_intrinsic)->getParams();
        Eigen::Matrix3Xd result(3, of_pair.size());
        for (std::size_t n = 0; n < of_pair.size(); ++n) {
          const auto& point = features->feats_per_view.at(
              id)[first ? of_pair[n].i_ : of_pair[n].j_];
          result.col(n) << (point.x() - k[1]) / k[0], (point.y() - k[2]) / k[0],
              1;
        }
        return result;
      };
      relative_poses_[entry.first] = PoseOf(rays(entry.first.first, true),
                                            rays(entry.first.second, false));
    }
    return !relative_poses_.empty();
  }
  Relative_Pair_Poses Get_Relative_Poses() const { return relative_poses_; }

 private:
  static geometry::Pose3 PoseOf(const Eigen::Matrix3Xd& x1,
                                const Eigen::Matrix3Xd& x2) {
    Eigen::Matrix<double, Eigen::Dynamic, 9> equations(x1.cols(), 9);
    for (Eigen::Index n = 0; n < x1.cols(); ++n) {
      const Mat3 row = x2.col(n) * x1.col(n).transpose();
      equations.row(n) = row.reshaped().transpose();
    }
    const Eigen::JacobiSVD<Eigen::MatrixXd> null(equations,
                                                 Eigen::ComputeFullV);
    const Mat3 essential = null.matrixV().col(8).reshaped(3, 3);
    const Eigen::JacobiSVD<Mat3> svd(essential,
                                     Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Mat3 quarter_turn =
        Eigen::AngleAxisd(std::acos(0.0), Vec3::UnitZ()).toRotationMatrix();
    geometry::Pose3 best;
    int most = -1;
    for (const Mat3& turn : {quarter_turn, Mat3(quarter_turn.transpose())}) {
      Mat3 rotation = svd.matrixU() * turn * svd.matrixV().transpose();
      if (rotation.determinant() < 0) rotation = -rotation;
      for (const double sign : {-1.0, 1.0}) {
        const Vec3 translation = sign * svd.matrixU().col(2);
        int in_front = 0;
        for (Eigen::Index n = 0; n < x1.cols(); ++n) {
          // depth2 x2 = depth1 rotation x1 + translation
          Eigen::Matrix<double, 3, 2> rays;
          rays << x2.col(n), -(rotation * x1.col(n));
          const Eigen::Vector2d depths =
              rays.jacobiSvd(Eigen::ComputeFullU | Eigen::ComputeFullV)
                  .solve(translation);
          in_front += depths.minCoeff() > 0;
        }
        if (in_front <= most) continue;
        most = in_front;
        best = {rotation, -(rotation.transpose() * translation)};
      }
    }
    return best;
  }

  Relative_Pair_Poses relative_poses_;
};

class ReconstructionEngine {
 public:
  ReconstructionEngine(const SfM_Data& sfm_data,
                       const std::string& soutDirectory)
      : sOut_directory_(soutDirectory), sfm_data_(sfm_data) {}
  virtual ~ReconstructionEngine() = default;
  virtual bool Process() = 0;
  const SfM_Data& Get_SfM_Data() const { return sfm_data_; }

 protected:
  std::string sOut_directory_;
  SfM_Data sfm_data_;
};

class GlobalSfMReconstructionEngine_RelativeMotions
    : public ReconstructionEngine {
 public:
  GlobalSfMReconstructionEngine_RelativeMotions(
      const SfM_Data& sfm_data, const std::string& soutDirectory,
      const std::string& /*loggingFile*/ = "")
      : ReconstructionEngine(sfm_data, soutDirectory) {}
  void SetFeaturesProvider(Features_Provider*) {}
  void SetMatchesProvider(Matches_Provider*) {}
  bool Process() override { return false; }

 protected:
  /// Along a spanning tree.
  bool Compute_Global_Rotations(
      const rotation_averaging::RelativeRotations& vec_relatives_R,
      Hash_Map<IndexT, Mat3>& map_globalR) {
    if (vec_relatives_R.empty()) return false;
    map_globalR[vec_relatives_R.front().i] = Mat3::Identity();
    for (bool grows = true; grows;) {
      grows = false;
      for (const auto& relative : vec_relatives_R) {
        const bool has_i = map_globalR.count(relative.i) > 0;
        if (has_i == (map_globalR.count(relative.j) > 0)) continue;
        if (has_i) {
          map_globalR[relative.j] = relative.Rij * map_globalR[relative.i];
        } else {
          map_globalR[relative.i] =
              relative.Rij.transpose() * map_globalR[relative.j];
        }
        grows = true;
      }
    }
    return true;
  }
  bool Compute_Initial_Structure(
      matching::PairWiseMatches& tripletWise_matches) {
    return !tripletWise_matches.empty();
  }
  bool Adjust() { return true; }
};

}  // namespace openMVG::sfm
