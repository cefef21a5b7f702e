#pragma once

#include <map>
#include <string>
#include <string_view>

#include "lowlap/core/result.h"
#include "lowlap/scene/intrinsic.h"
#include "lowlap/scene/view.h"

namespace lowlap::strecha {

// The files of the multi-view benchmark of Strecha et al., CVPR 2008.

/// A `K.txt`: nine numbers, row by row,
///   fx 0 cx / 0 fy cy / 0 0 1,
/// with commas, semicolons, brackets, and comments after # about them.
/// fx and fy are both kept. The file has no image size. Errors: kParse unless
/// it holds nine finite numbers; kUnsupported for skew or a last row other
/// than 0 0 1; kInvalidArgument for a focal length that is not positive.
Result<Mat3> ReadCalibrationMatrix(const std::string& path);
Result<Mat3> ParseCalibrationMatrix(std::string_view text,
                                    const std::string& file = {});

/// The pinhole camera of a calibration matrix.
Intrinsic PinholeFromMatrix(const Mat3& calibration, int width_px,
                            int height_px);

/// One ground-truth camera.
struct Camera {
  Intrinsic intrinsic;  // pinhole
  Pose pose;            // centre in the unit of the file (metres)
};

/// A `.camera` file: K (9 numbers), 0 0 0, R (9), C (3), width height, where R
/// is stored camera-to-world: x_cam = R^T (X - C). R is rounded in the file;
/// the nearest rotation is returned. Errors: as for K, and kParse for a matrix
/// that is no rotation (to 1e-3).
Result<Camera> ReadCamera(const std::string& path);
Result<Camera> ParseCamera(std::string_view text, const std::string& file = {});

/// All cameras of a folder by the name of their image ("0000.jpg" for
/// 0000.jpg.camera). `dir` is the folder of the .camera files, or the one that
/// holds it as gt_dense_cameras. kNotFound if there are none.
Result<std::map<std::string, Camera>> ReadCameras(const std::string& dir);

/// The poses alone.
Result<std::map<std::string, Pose>> ReadGroundTruth(const std::string& dir);

}  // namespace lowlap::strecha
