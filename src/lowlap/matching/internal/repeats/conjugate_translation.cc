#include "lowlap/matching/internal/repeats/conjugate_translation.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace lowlap {
namespace {

constexpr int kUnknowns = 4;

// The s of to ~ from + s v.
double StepAlong(const Vec3& v, const AlikePlaces& places) {
  const Vec3 across = places.to.cross(v);
  return -places.to.cross(places.from).dot(across) / across.squaredNorm();
}

Eigen::Matrix<double, 3, 2> BasisAcross(const Vec3& unit) {
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = unit.unitOrthogonal();
  basis.col(1) = unit.cross(basis.col(0));
  return basis;
}

Vec3 Unscaled(const ConjugateTranslation& translation, const Vec3& x) {
  return x + translation.vanishing_point * translation.vanishing_line.dot(x);
}

double SquaredMiss(const Vec3& mapped, const AlikePlaces& places) {
  return mapped.z() > 0 ? (mapped / mapped.z() - places.to).squaredNorm()
                        : HUGE_VAL;
}

}  // namespace

std::optional<Vec3> ConjugateTranslation::Map(const Vec3& x) const {
  const Vec3 mapped = Unscaled(*this, x);
  if (!(mapped.z() > 0)) return std::nullopt;
  return Vec3(mapped / mapped.z());
}

bool ConjugateTranslation::Explains(const AlikePlaces& places) const {
  return SquaredMiss(Unscaled(*this, places.from), places) <
         places.tolerance * places.tolerance;
}

std::optional<ConjugateTranslation> ConjugateTranslation::FromTwo(
    const AlikePlaces& a, const AlikePlaces& b) {
  const Vec3 v = a.from.cross(a.to).cross(b.from.cross(b.to)).normalized();
  Mat3 equations;
  equations << a.from.transpose(), b.from.transpose(), v.transpose();
  const Vec3 steps(StepAlong(v, a), StepAlong(v, b), 0);
  const Vec3 line = equations.partialPivLu().solve(steps);
  const double length = line.norm();
  if (!(std::isfinite(length) && length > 0)) return std::nullopt;
  const ConjugateTranslation result = {v * length, line / length};
  // What is close to singular does not fit what it was made of.
  if (!result.Explains(a) || !result.Explains(b)) return std::nullopt;
  return result;
}

std::optional<ConjugateTranslation> ConjugateTranslation::FromOne(
    const AlikePlaces& places, const Vec3& vanishing_line) {
  // Rays of one depth from the plane's horizon: their difference lies in it.
  const Vec3 v = places.to / vanishing_line.dot(places.to) -
                 places.from / vanishing_line.dot(places.from);
  const ConjugateTranslation result = {v, vanishing_line};
  if (!result.Explains(places)) return std::nullopt;
  return result;
}

std::optional<ConjugateTranslation> ConjugateTranslation::Refined(
    const std::vector<AlikePlaces>& places, std::size_t most,
    double tolerance_factor) const {
  const Vec3 &v = vanishing_point, &l = vanishing_line;
  const Eigen::Matrix<double, 3, 2> across = BasisAcross(l);
  Eigen::Matrix<double, kUnknowns, kUnknowns> normal;
  Eigen::Matrix<double, kUnknowns, 1> gradient;
  normal.setZero();
  gradient.setZero();
  int count = 0;
  for (std::size_t n = 0; n < std::min(most, places.size()); ++n) {
    const AlikePlaces& each = places[n];
    const Vec3 mapped = Unscaled(*this, each.from);
    const double reach = tolerance_factor * each.tolerance;
    if (!(SquaredMiss(mapped, each) < reach * reach)) continue;
    ++count;
    const Vec2 image = mapped.hnormalized();
    Eigen::Matrix<double, 2, 3> by_mapped;
    by_mapped << 1, 0, -image.x(), 0, 1, -image.y();
    by_mapped /= mapped.z();
    // l moves by B a and v by B b - l (v . B a), so that l . v stays zero.
    const double along = l.dot(each.from);
    Eigen::Matrix<double, 3, kUnknowns> by_unknowns;
    by_unknowns << (v * each.from.transpose() - along * l * v.transpose()) *
                       across,
        along * across;
    const Eigen::Matrix<double, 2, kUnknowns> by =
        by_mapped * by_unknowns / each.tolerance;
    const Vec2 residual = (image - each.to.hnormalized()) / each.tolerance;
    normal += by.transpose() * by;
    gradient += by.transpose() * residual;
  }
  if (2 * count <= kUnknowns) return std::nullopt;
  const Eigen::Matrix<double, kUnknowns, 1> step =
      -normal.ldlt().solve(gradient);
  if (!step.allFinite()) return std::nullopt;
  ConjugateTranslation result;
  result.vanishing_line = (l + across * step.head<2>()).normalized();
  const Vec3 moved = v + across * step.tail<2>();
  result.vanishing_point =
      moved - result.vanishing_line * result.vanishing_line.dot(moved);
  return result;
}

}  // namespace lowlap
