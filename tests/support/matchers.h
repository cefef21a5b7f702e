#pragma once

#include <gmock/gmock.h>

#include "lowlap/core/result.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scene/view.h"

namespace lowlap::testing {

/// A Result or Status that holds no error.
MATCHER(IsOk, negation ? "is an error" : "is not an error") {
  if (arg.has_value()) return true;
  *result_listener << "error: " << arg.error().ToString();
  return false;
}

/// A Result or Status with this code and this text somewhere in its message.
MATCHER_P2(IsError, code, text, "is the error with the text") {
  if (arg.has_value()) {
    *result_listener << "no error";
    return false;
  }
  *result_listener << ErrorCodeName(arg.error().code) << ": "
                   << arg.error().ToString();
  return arg.error().code == code &&
         arg.error().ToString().find(text) != std::string::npos;
}

/// Options with this value of a member are refused with this text.
template <class Options, class Member, class Value>
void ExpectRefused(Member Options::*member, const Value& value,
                   const char* text) {
  Options options;
  options.*member = value;
  EXPECT_THAT(options.Validate(), IsError(ErrorCode::kInvalidArgument, text));
}

/// A rotation within an angle of the expected one.
MATCHER_P2(RotationNear, expected, max_angle_deg, "is near the rotation") {
  const double angle = DegFromRad(RotationAngleBetween(arg, expected));
  *result_listener << angle << " degrees away";
  return angle <= max_angle_deg;
}

/// A Vec2 or Vec3 within a distance of the expected one.
MATCHER_P2(VectorNear, expected, max_distance, "is near the vector") {
  const double distance = (arg - expected).norm();
  *result_listener << distance << " away";
  return distance <= max_distance;
}

/// A Pose near the expected one, in the same world frame.
MATCHER_P3(PoseNear, expected, max_angle_deg, max_distance,
           "is near the pose") {
  const double angle =
      DegFromRad(RotationAngleBetween(arg.rotation, expected.rotation));
  const double distance = (arg.center - expected.center).norm();
  *result_listener << angle << " degrees and " << distance << " away";
  return angle <= max_angle_deg && distance <= max_distance;
}

}  // namespace lowlap::testing
