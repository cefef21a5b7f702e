#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/flags/command_line.h"
#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap::cli {

inline constexpr char kDefaultCoplanarTies[] = "planes";

/// --coplanar-ties
void AddCoplanarTiesFlag(CLI::App* command, std::optional<std::string>* ties);
/// --directions
void AddDirectionsFlag(CLI::App* command, std::optional<bool>* directions);
/// --adjust-features, --coplanar-ties, --directions, --principal-point-stddev:
/// without an adjustment they have no effect.
std::vector<std::string> OptionsOfAdjustment();
/// What the first three of these choose. kInvalidArgument if that is unknown.
Status ChooseAdjustment(const std::vector<std::string>& features,
                        const std::optional<std::string>& coplanar_ties,
                        std::optional<bool> directions,
                        AdjustmentOptions* options);
/// Warnings of ties and directions that are asked for, and that the other
/// options leave without effect.
void WarnOfIdleTies(const std::optional<std::string>& coplanar_ties,
                    std::optional<bool> directions,
                    const AdjustmentOptions& options,
                    const RunContext& context);
/// --principal-point-stddev
void AddPrincipalPointFlag(CLI::App* command, double* stddev);

}  // namespace lowlap::cli
