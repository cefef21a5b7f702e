#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scale/evidence/evidence_kind.h"
#include "lowlap/scale/triplet_view.h"
#include "lowlap/scene/scale_ratio.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The order that leaves no thread with a large triplet at the end: many
/// matches first.
std::vector<std::size_t> LargestFirst(const Scene& scene,
                                      const std::vector<ViewTriplet>& triplets);

/// The kinds of one round, prepared for the triplets.
/// Errors: those of EvidenceKind::Prepare.
Result<EvidenceKinds> PrepareRound(const EvidenceKinds& kinds,
                                   EvidenceRound round,
                                   const SceneFeatures& features,
                                   const std::vector<ViewTriplet>& triplets,
                                   const RunContext& context);

/// Whether a kind of the round may say something about the triplet.
bool MaySpeak(const EvidenceKinds& kinds, EvidenceRound round,
              const SceneFeatures& features, const ViewTriplet& views);

/// The ratio of an outcome of a test; see also RatioProfile.
inline ScaleRatio& RatioOf(ScaleRatio& ratio) { return ratio; }

/// Whether all numbers of the ratio are finite.
bool IsDefined(const ScaleRatio& ratio);

/// Warns of the triplets whose last test failed, if there are any.
void WarnOfFailures(const Scene& scene,
                    const std::vector<ViewTriplet>& triplets,
                    const std::vector<const Error*>& failures,
                    const RunContext& context);

/// `test` of every triplet, in parallel:
/// Result<Outcome>(TripletView, TripletEvidence). Triplets without features
/// have no candidates. A test that fails, or gives numbers that are not finite,
/// does not lose the others. Errors: those of MakeTripletView, kCancelled.
template <class Outcome, class Test>
Result<std::vector<Result<Outcome>>> TestOnce(
    const SceneFeatures& features, const std::vector<ViewTriplet>& triplets,
    const EvidenceKinds& kinds, int num_tests, const RunContext& context,
    const char* stage, const Test& test) {
  const std::vector<std::size_t> order = LargestFirst(features.scene, triplets);
  std::vector<Status> made(triplets.size());
  std::vector<Result<Outcome>> results(triplets.size());
  const Status status =
      ParallelFor(context, stage, triplets.size(), [&](std::size_t n) {
        const ViewTriplet& views = triplets[order[n]];
        Result<Outcome>& result = results[order[n]];
        RatioOf(*result).views = views;
        if (!features.HasAll(views)) return;
        const Result<TripletView> triplet = MakeTripletView(features, views);
        if (!triplet) {
          made[order[n]] = tl::unexpected<Error>(triplet.error());
          return;
        }
        TripletEvidence evidence = GatherEvidence(kinds, *triplet);
        evidence.num_tests = num_tests;
        result = test(*triplet, evidence);
        if (result && !IsDefined(RatioOf(*result))) {
          result = MakeError(ErrorCode::kNumerical, "it is not finite");
        }
      });
  if (!status) return tl::unexpected<Error>(status.error());
  for (std::size_t n = 0; n < triplets.size(); ++n) {
    if (!made[n]) return tl::unexpected<Error>(std::move(made[n].error()));
    if (!results[n] && results[n].error().code == ErrorCode::kCancelled) {
      return tl::unexpected<Error>(std::move(results[n].error()));
    }
  }
  return results;
}

/// The same in rounds: triplets that are not meaningful by the kinds of the
/// first round are tested a second time, with those of kUndecided as well, if
/// one of these may speak. Outcomes are those of the last test that did not
/// fail, in the order of the triplets, without candidates if all did; a warning
/// tells of last tests that failed. `num_before`: tests that the triplets had
/// already.
template <class Outcome, class Test>
Result<std::vector<Outcome>> TestTriplets(
    const Scene& scene, const std::vector<ViewTriplet>& triplets,
    const EvidenceKinds& kinds, const RunContext& context, const char* stage,
    const Test& test, int num_before = 0) {
  const SceneFeatures features(scene);
  auto asked =
      PrepareRound(kinds, EvidenceRound::kFirst, features, triplets, context);
  if (!asked) return tl::unexpected<Error>(asked.error());
  auto tested = TestOnce<Outcome>(features, triplets, *asked, num_before + 1,
                                  context, stage, test);
  if (!tested) return tl::unexpected<Error>(tested.error());
  std::vector<const Error*> failures(triplets.size(), nullptr);
  std::vector<std::size_t> undecided;
  std::vector<ViewTriplet> undecided_triplets;
  for (std::size_t n = 0; n < triplets.size(); ++n) {
    Result<Outcome>& first = (*tested)[n];
    if (!first) failures[n] = &first.error();
    if ((!first || RatioOf(*first).verdict != RatioVerdict::kMeaningful) &&
        features.HasAll(triplets[n]) &&
        MaySpeak(kinds, EvidenceRound::kUndecided, features, triplets[n])) {
      undecided.push_back(n);
      undecided_triplets.push_back(triplets[n]);
    }
  }
  Result<std::vector<Result<Outcome>>> again;
  if (!undecided.empty()) {
    const auto more = PrepareRound(kinds, EvidenceRound::kUndecided, features,
                                   undecided_triplets, context);
    if (!more) return tl::unexpected<Error>(more.error());
    asked->insert(asked->end(), more->begin(), more->end());
    again = TestOnce<Outcome>(features, undecided_triplets, *asked,
                              num_before + 2, context, stage, test);
    if (!again) return tl::unexpected<Error>(again.error());
  }
  for (std::size_t n = 0; n < undecided.size(); ++n) {
    Result<Outcome>& second = (*again)[n];
    failures[undecided[n]] = second ? nullptr : &second.error();
    if (second) (*tested)[undecided[n]] = std::move(second);
  }
  WarnOfFailures(scene, triplets, failures, context);
  std::vector<Outcome> outcomes(triplets.size());
  for (std::size_t n = 0; n < triplets.size(); ++n) {
    RatioOf(outcomes[n]).views = triplets[n];
    if ((*tested)[n]) outcomes[n] = std::move(*(*tested)[n]);
  }
  return outcomes;
}

}  // namespace lowlap
