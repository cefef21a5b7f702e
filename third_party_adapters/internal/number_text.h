#pragma once

#include <string>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/token_reader.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// Numbers with the digits that restore them, blanks between.
template <class Values>
std::string NumberText(const Values& values) {
  std::string text;
  for (const double value : values) {
    text += Format(text.empty() ? "%.17g" : " %.17g", value);
  }
  return text;
}

/// A matrix as lines of numbers, each ended.
std::string RowsText(const Mat3& matrix);

/// The next numbers of a text.
Vec2 NextVec2(const char* what, TokenReader* reader);
Vec3 NextVec3(const char* what, TokenReader* reader);

/// The rotation nearest to what a file has rounded; `whose` matrix it is, for
/// the message. The reader fails if the two differ by more than 1e-3.
Mat3 CheckedRotation(const Mat3& matrix, const std::string& whose,
                     TokenReader* reader);

/// The next nine numbers, row by row, as a CheckedRotation.
Mat3 NextRotation(const std::string& whose, TokenReader* reader);

/// The rotation of a quaternion w x y z. The reader fails if its length differs
/// from 1 by more than 1e-2.
Mat3 CheckedRotation(const Vec4& quaternion_wxyz, const std::string& whose,
                     TokenReader* reader);

/// The quaternion w x y z of a rotation, w >= 0.
Vec4 QuaternionOf(const Mat3& rotation);

}  // namespace lowlap
