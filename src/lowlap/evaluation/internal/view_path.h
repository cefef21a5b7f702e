#pragma once

#include <string>

#include "lowlap/scene/view.h"

namespace lowlap {

/// The path of a photograph below the image folder: what tells images of one
/// file name apart.
inline std::string PathOf(const View& view) {
  return view.local_path.empty() ? view.filename
                                 : view.local_path + "/" + view.filename;
}

}  // namespace lowlap
