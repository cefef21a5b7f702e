#pragma once

#include <string>
#include <vector>

#include "lowlap/core/result.h"

namespace lowlap::cli {

/// A file of the command line; an empty path: none.
struct NamedFile {
  std::string what;  // "--json", "the scene"
  std::string path;
};

/// That nothing is written over an input, nor twice. What counts is the file,
/// not its name: links and "." are followed. Error: kInvalidArgument.
Status CheckDistinct(const std::vector<NamedFile>& inputs,
                     const std::vector<NamedFile>& outputs);

}  // namespace lowlap::cli
