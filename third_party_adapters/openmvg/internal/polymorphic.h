#pragma once

#include <cstdint>

namespace lowlap::openmvg {

// The ids that cereal puts before a pointer: first the id of the type, then
// that of the object.

/// Set in an id that defines: the type's name, or the object's content,
/// follows.
inline constexpr std::uint32_t kDefines = 0x80000000u;

/// Instead of a type id: the object has the pointer's own static type.
inline constexpr std::uint32_t kStaticType = 0x40000000u;

}  // namespace lowlap::openmvg
