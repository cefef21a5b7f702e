// Writes the scene in which every member is filled, for check_schema.py.
#include <cstdio>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/io/internal/json/scene_json.h"
#include "scene/example_scenes.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const lowlap::Status status = lowlap::WriteFileAtomically(
      argv[1], lowlap::FormatSceneJson(lowlap::testing::FullScene()).value());
  if (status) return 0;
  std::fprintf(stderr, "%s\n", status.error().ToString().c_str());
  return 1;
}
