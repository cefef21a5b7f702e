#include "third_party_adapters/internal/number_text.h"

#include <cmath>

#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {

std::string RowsText(const Mat3& matrix) {
  std::string text;
  for (int row = 0; row < 3; ++row) {
    text += NumberText(Vec3(matrix.row(row))) + "\n";
  }
  return text;
}

Vec2 NextVec2(const char* what, TokenReader* reader) {
  const double x = reader->Next<double>(what);
  return {x, reader->Next<double>(what)};
}

Vec3 NextVec3(const char* what, TokenReader* reader) {
  const Vec2 xy = NextVec2(what, reader);
  return {xy.x(), xy.y(), reader->Next<double>(what)};
}

Mat3 CheckedRotation(const Mat3& matrix, const std::string& whose,
                     TokenReader* reader) {
  const Mat3 nearest = NearestRotation(matrix);
  if (!((nearest - matrix).cwiseAbs().maxCoeff() < 1e-3)) {
    reader->Fail("the matrix of " + whose + " is no rotation");
  }
  return nearest;
}

Mat3 NextRotation(const std::string& whose, TokenReader* reader) {
  Mat3 matrix = Mat3::Identity();
  for (int row = 0; row < 3; ++row) {
    matrix.row(row) = NextVec3("a number of the rotation", reader);
  }
  return reader->status() ? CheckedRotation(matrix, whose, reader)
                          : Mat3::Identity();
}

Mat3 CheckedRotation(const Vec4& q, const std::string& whose,
                     TokenReader* reader) {
  if (!(std::abs(q.norm() - 1) < 1e-2)) {
    reader->Fail("the quaternion of " + whose + " is not of length 1");
  }
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3])
      .normalized()
      .toRotationMatrix();
}

Vec4 QuaternionOf(const Mat3& rotation) {
  const Eigen::Quaterniond q(rotation);
  const Vec4 wxyz(q.w(), q.x(), q.y(), q.z());
  return (wxyz[0] < 0 ? -1.0 : 1.0) * wxyz.normalized();
}

}  // namespace lowlap
