#pragma once

#include <string>

namespace lowlap {

/// The folder with the photographs and reference solutions that slow tests
/// measure on: the environment variable LOWLAP_DATA, or shared/data beside the
/// source folder. Empty if there is none.
std::string DataFolder();

/// The folder of the sources, for the samples that come with them.
std::string SourceFolder();

/// The bundled room: photographs, their calibration, and true cameras.
std::string RoomFolder();

}  // namespace lowlap
