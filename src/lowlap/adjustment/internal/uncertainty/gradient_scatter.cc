#include "lowlap/adjustment/internal/uncertainty/gradient_scatter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "lowlap/scene/internal/common_errors.h"

namespace lowlap {
namespace {

// Where a landmark is first seen; in cells.
struct ImagePlace {
  int view = -1;  // -1: nowhere
  Vec2 cell = Vec2::Zero();
};

std::optional<Vec2> PixelOf(const CameraSet&, const PointCandidate& seen) {
  return seen.pixel_px;
}

std::optional<Vec2> PixelOf(const CameraSet& cameras,
                            const LineCandidate& seen) {
  const Vec3 middle = seen.rays.ends[0].ray + seen.rays.ends[1].ray;
  const int intrinsic = cameras.views[seen.view].intrinsic;
  return cameras.intrinsics[intrinsic].value.Project(middle);
}

template <class Track>
ImagePlace FirstPlace(const CameraSet& cameras, const Track& track) {
  for (const auto& seen : track.candidates) {
    if (!seen.used) continue;
    const std::optional<Vec2> pixel_px = PixelOf(cameras, seen);
    const double diagonal_px =
        cameras.intrinsics[cameras.views[seen.view].intrinsic]
            .value.ImageDiagonal();
    if (!pixel_px || !pixel_px->allFinite()) break;
    return {seen.view, *pixel_px / (kCommonErrorShare * diagonal_px)};
  }
  return {};
}

}  // namespace

SparseMat ScatterOfGradients(const LinearisedProblem& linearised,
                             const ProblemBuilder& builder,
                             const ProblemSelection& selection,
                             const CameraSet& cameras,
                             const StructureState& state) {
  std::vector<ImagePlace> places;  // of the first rows of the gradients
  for (const int n : builder.eliminated_lines()) {
    places.push_back(FirstPlace(cameras, state.lines[n]));
  }
  for (const int n : selection.points) {
    places.push_back(FirstPlace(cameras, state.points[n]));
  }
  places.resize(static_cast<std::size_t>(linearised.gradients.rows()));

  SparseMat scatter(linearised.kept_size, linearised.kept_size);
  for (const Vec2& shift :
       {Vec2(0, 0), Vec2(0.5, 0), Vec2(0, 0.5), Vec2(0.5, 0.5)}) {
    std::map<std::array<double, 3>, int> row_of_cell;
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index n = 0; n < linearised.gradients.rows(); ++n) {
      const ImagePlace& place = places[static_cast<std::size_t>(n)];
      const Vec2 cell = (place.cell + shift).array().floor();
      // What is nowhere is on its own.
      const std::array<double, 3> key =
          place.view >= 0
              ? std::array{static_cast<double>(place.view), cell.x(), cell.y()}
              : std::array{-1.0, static_cast<double>(n), 0.0};
      const int row =
          row_of_cell.emplace(key, static_cast<int>(row_of_cell.size()))
              .first->second;
      for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(
               linearised.gradients, n);
           it; ++it) {
        entries.emplace_back(row, static_cast<int>(it.col()), it.value());
      }
    }
    SparseMat sums(static_cast<Eigen::Index>(row_of_cell.size()),
                   linearised.kept_size);
    sums.setFromTriplets(entries.begin(), entries.end());
    scatter += 0.25 * SparseMat(sums.transpose() * sums);
  }
  return scatter;
}

}  // namespace lowlap
