#include "lowlap/two_view/internal/kernels/five_point.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <optional>

#include "lowlap/two_view/internal/kernels/polynomial.h"

namespace lowlap {
namespace {

using Mat9x4 = Eigen::Matrix<double, 9, 4>;
using Linear = std::array<double, 4>;      // x y z 1
using Quadratic = std::array<double, 10>;  // xx xy xz x yy yz y zz z 1
// Nistér's order of the monomials, so that the first ten are eliminated:
// xxx yyy xxy xyy xxz xx yyz yy xyz xy | xzz xz x yzz yz y zzz zz z 1
using Cubic = Eigen::Matrix<double, 1, 20>;
using Polynomial = std::vector<double>;  // in z, from the constant up

// kQuadraticIndex[i][j]: where the product of variables i and j goes.
constexpr int kQuadraticIndex[4][4] = {
    {0, 1, 2, 3}, {1, 4, 5, 6}, {2, 5, 7, 8}, {3, 6, 8, 9}};
// kCubicIndex[q][i]: where the product of quadratic term q and variable i goes.
constexpr int kCubicIndex[10][4] = {
    {0, 2, 4, 5},      // xx
    {2, 3, 8, 9},      // xy
    {4, 8, 10, 11},    // xz
    {5, 9, 11, 12},    // x
    {3, 1, 6, 7},      // yy
    {8, 6, 13, 14},    // yz
    {9, 7, 14, 15},    // y
    {10, 13, 16, 17},  // zz
    {11, 14, 17, 18},  // z
    {12, 15, 18, 19},  // 1
};

void AddProduct(const Linear& a, const Linear& b, double factor,
                Quadratic& sum) {
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      sum[kQuadraticIndex[i][j]] += factor * a[i] * b[j];
    }
  }
}

void AddProduct(const Quadratic& a, const Linear& b, Cubic& sum) {
  for (int q = 0; q < 10; ++q) {
    for (int i = 0; i < 4; ++i) sum[kCubicIndex[q][i]] += a[q] * b[i];
  }
}

/// Orthonormal basis of the matrices that satisfy the five equations, as rows
/// of a 9-vector (row-major E); nullopt if the equations are dependent.
std::optional<Mat9x4> NullSpace(const FivePoints& x1, const FivePoints& x2) {
  Eigen::Matrix<double, 9, 5> equations;
  for (int n = 0; n < 5; ++n) {
    const Vec3 a = x1[n].normalized();
    const Vec3 b = x2[n].normalized();
    for (int i = 0; i < 3; ++i) equations.block<3, 1>(3 * i, n) = b[i] * a;
  }
  if (!equations.allFinite()) return std::nullopt;
  const Eigen::HouseholderQR<Eigen::Matrix<double, 9, 5>> qr(equations);
  if (qr.matrixQR().diagonal().cwiseAbs().minCoeff() < 1e-10) {
    return std::nullopt;
  }
  Mat9x4 basis = Mat9x4::Zero();
  basis.bottomRows<4>().setIdentity();
  basis.applyOnTheLeft(qr.householderQ());
  return basis;
}

/// The ten cubic constraints on (x, y, z): 2 E E^T E - tr(E E^T) E = 0 and
/// det E = 0.
Eigen::Matrix<double, 10, 20> CubicConstraints(const Mat9x4& basis) {
  Linear e[3][3];
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 4; ++j) e[i / 3][i % 3][j] = basis(i, j);
  }
  Quadratic gram[3][3] = {};  // E E^T - tr(E E^T) I / 2
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) AddProduct(e[i][k], e[j][k], 1, gram[i][j]);
    }
  }
  for (int q = 0; q < 10; ++q) {
    const double half_trace =
        0.5 * (gram[0][0][q] + gram[1][1][q] + gram[2][2][q]);
    for (int i = 0; i < 3; ++i) gram[i][i][q] -= half_trace;
  }
  gram[1][0] = gram[0][1];
  gram[2][0] = gram[0][2];
  gram[2][1] = gram[1][2];

  Eigen::Matrix<double, 10, 20> constraints;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      Cubic row = Cubic::Zero();
      for (int k = 0; k < 3; ++k) AddProduct(gram[i][k], e[k][j], row);
      constraints.row(3 * i + j) = row;
    }
  }
  Cubic determinant = Cubic::Zero();
  for (int j = 0; j < 3; ++j) {
    const int k = (j + 1) % 3;
    const int l = (j + 2) % 3;
    Quadratic minor = {};
    AddProduct(e[1][k], e[2][l], 1, minor);
    AddProduct(e[1][l], e[2][k], -1, minor);
    AddProduct(minor, e[0][j], determinant);
  }
  constraints.row(9) = determinant;
  return constraints;
}

Polynomial Product(const Polynomial& a, const Polynomial& b) {
  Polynomial product(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) product[i + j] += a[i] * b[j];
  }
  return product;
}

Polynomial Difference(Polynomial a, const Polynomial& b) {
  a.resize(std::max(a.size(), b.size()), 0.0);
  for (std::size_t i = 0; i < b.size(); ++i) a[i] -= b[i];
  return a;
}

/// sum of p_i z^i w^(degree - i), where z or w is 1.
double Homogeneous(const Polynomial& p, double z, double w) {
  double value = 0;
  if (w == 1) {
    for (auto c = p.rbegin(); c != p.rend(); ++c) value = value * z + *c;
  } else {
    for (const double c : p) value = value * w + c;
  }
  return value;
}

/// B(z) with B(z) (x, y, 1)^T = 0 at every solution: each row is one
/// eliminated equation minus z times the next, which cancels their heads.
using PolynomialMatrix = std::array<std::array<Polynomial, 3>, 3>;

PolynomialMatrix EliminateXY(const Eigen::Matrix<double, 6, 10>& tail) {
  PolynomialMatrix b;
  for (int r = 0; r < 3; ++r) {
    const auto e = tail.row(2 * r);
    const auto f = tail.row(2 * r + 1);
    b[r][0] = {e[2], e[1] - f[2], e[0] - f[1], -f[0]};
    b[r][1] = {e[5], e[4] - f[5], e[3] - f[4], -f[3]};
    b[r][2] = {e[9], e[8] - f[9], e[7] - f[8], e[6] - f[7], -f[6]};
  }
  return b;
}

/// 2 E E^T E - tr(E E^T) E, zero exactly for essential matrices.
Mat3 Defect(const Mat3& e) {
  const Mat3 gram = e * e.transpose();
  return 2 * gram * e - gram.trace() * e;
}

/// Gauss-Newton on the cubic constraints within the null space.
Mat3 Polish(const std::array<Mat3, 4>& basis, Vec4 v) {
  const auto combine = [&](const Vec4& w) -> Mat3 {
    return w[0] * basis[0] + w[1] * basis[1] + w[2] * basis[2] +
           w[3] * basis[3];
  };
  v.normalize();
  Mat3 e = combine(v);
  for (int iteration = 0; iteration < 4; ++iteration) {
    const Mat3 gram = e * e.transpose();
    const Mat3 defect = 2 * gram * e - gram.trace() * e;
    if (defect.cwiseAbs().maxCoeff() < 1e-15) break;
    const Mat3 inner = e.transpose() * e;
    Eigen::Matrix<double, 9, 4> jacobian;
    for (int k = 0; k < 4; ++k) {
      const Mat3& n = basis[k];
      const Mat3 change = 2 * (n * inner + e * (n.transpose() * e) + gram * n) -
                          2 * e.cwiseProduct(n).sum() * e - gram.trace() * n;
      jacobian.col(k) =
          Eigen::Map<const Eigen::Matrix<double, 9, 1>>(change.data());
    }
    // v v^T fixes the scale of v.
    const Eigen::Matrix4d normal =
        jacobian.transpose() * jacobian + v * v.transpose();
    const Vec4 rhs =
        jacobian.transpose() *
        Eigen::Map<const Eigen::Matrix<double, 9, 1>>(defect.data());
    const Vec4 next = (v - normal.partialPivLu().solve(rhs)).normalized();
    if (!next.allFinite()) break;
    v = next;
    e = combine(v);
  }
  return e;
}

}  // namespace

std::vector<Mat3> EssentialFromFivePoints(const FivePoints& x1,
                                          const FivePoints& x2) {
  const std::optional<Mat9x4> null_space = NullSpace(x1, x2);
  if (!null_space) return {};
  const Eigen::Matrix<double, 10, 20> constraints =
      CubicConstraints(*null_space);
  const Eigen::Matrix<double, 10, 10> reduced =
      constraints.leftCols<10>().partialPivLu().solve(
          constraints.rightCols<10>());
  if (!reduced.allFinite()) return {};
  const PolynomialMatrix b = EliminateXY(reduced.bottomRows<6>());

  // Minors of the first two rows: (x, y, 1) is parallel to them at a root.
  const auto minor = [&](int r, int s, int i, int j) {
    return Difference(Product(b[r][i], b[s][j]), Product(b[r][j], b[s][i]));
  };
  Polynomial determinant = Product(minor(0, 1, 1, 2), b[2][0]);
  const Polynomial second = Product(minor(0, 1, 2, 0), b[2][1]);
  const Polynomial third = Product(minor(0, 1, 0, 1), b[2][2]);
  for (int i = 0; i <= 10; ++i) determinant[i] += second[i] + third[i];

  std::array<Mat3, 4> basis;
  for (int k = 0; k < 4; ++k) {
    basis[k] = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
        null_space->col(k).data());
  }
  std::vector<Mat3> essentials;
  // The root z / w, with z or w = 1: the polynomials of degree d homogenised,
  // z^i w^(d-i), give B (x w, y w, 1)^T = 0 and w E = x w X + y w Y + z Z + w
  // W.
  const auto add_root = [&](double z, double w) {
    Mat3 at_root;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) at_root(r, c) = Homogeneous(b[r][c], z, w);
    }
    Vec3 best = at_root.row(0).cross(at_root.row(1));
    for (int r = 1; r < 3; ++r) {
      const Vec3 cross = at_root.row(r).cross(at_root.row((r + 1) % 3));
      if (cross.squaredNorm() > best.squaredNorm()) best = cross;
    }
    best.normalize();
    if (!best.allFinite()) return;
    const Mat3 e =
        Polish(basis, Vec4(best[0], best[1], best[2] * z, best[2] * w));
    if (!(Defect(e).norm() < 1e-10)) return;
    const Mat3 scaled = e * (std::sqrt(2.0) / e.norm());
    for (const Mat3& other : essentials) {
      if (std::abs(std::abs(other.cwiseProduct(scaled).sum()) - 2) < 1e-14) {
        return;
      }
    }
    if (essentials.size() < 10) essentials.push_back(scaled);
  };
  // Roots beyond 1 are those of the reversed polynomial within 1, so that
  // neither large roots nor large powers arise.
  for (const double z : RealRootsInInterval(determinant, -1, 1)) {
    add_root(z, 1);
  }
  const Polynomial reversed(determinant.rbegin(), determinant.rend());
  for (const double w : RealRootsInInterval(reversed, -1, 1)) {
    if (std::abs(w) < 1) add_root(1, w);
  }
  return essentials;
}

std::array<RigidTransform, 4> PosesFromEssential(const Mat3& essential) {
  const Mat3 e = essential * (std::sqrt(2.0) / essential.norm());
  Vec3 t = e.col(0).cross(e.col(1));
  for (int i = 1; i < 3; ++i) {
    const Vec3 cross = e.col(i).cross(e.col((i + 1) % 3));
    if (cross.squaredNorm() > t.squaredNorm()) t = cross;
  }
  t.normalize();
  // E = [t]x R gives cof(E) = t t^T R and [t]x E = t t^T R - R.
  Mat3 cofactor;
  for (int i = 0; i < 3; ++i) {
    cofactor.row(i) = e.row((i + 1) % 3).cross(e.row((i + 2) % 3));
  }
  Mat3 cross_e;
  for (int i = 0; i < 3; ++i) cross_e.col(i) = t.cross(e.col(i));
  const auto orthonormal = [](const Mat3& m) -> Mat3 {
    return 0.5 * m * (3 * Mat3::Identity() - m.transpose() * m);
  };
  const Mat3 r = orthonormal(cofactor - cross_e);
  const Mat3 s = orthonormal(cofactor + cross_e);
  return {RigidTransform{r, t}, RigidTransform{r, -t}, RigidTransform{s, t},
          RigidTransform{s, -t}};
}

}  // namespace lowlap
