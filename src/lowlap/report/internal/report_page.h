#pragma once

namespace lowlap {

/// The fixed parts of the page: head and style, and the script that draws
/// `const drawing` into <canvas id="drawing">.
extern const char* const kReportStyle;
extern const char* const kReportScript;

}  // namespace lowlap
