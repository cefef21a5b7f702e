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

/// That neither a result that WriteOutputs writes to the folder nor
/// `scene_file` takes the place of an input. Error: kInvalidArgument.
Status CheckInputsStay(const std::vector<NamedFile>& inputs,
                       const std::string& output_folder,
                       const std::string& scene_file = {});

}  // namespace lowlap::cli
