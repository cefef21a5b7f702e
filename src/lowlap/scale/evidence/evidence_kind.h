#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scale/evidence/evidence.h"
#include "lowlap/scale/triplet_view.h"

namespace lowlap {

/// When a kind of evidence is asked.
enum class EvidenceRound {
  kFirst,
  /// About triplets whose ratio is not meaningful by the others: a second test,
  /// together with them, which costs log10 2.
  kUndecided,
};

/// A kind of evidence, which finds what there is of it in a triplet. It may
/// carry data of its own, by view (TripletView::views). Shared by threads.
class EvidenceKind {
 public:
  virtual ~EvidenceKind() = default;

  /// What tables and files call it; not that of another kind.
  virtual std::string Name() const = 0;
  virtual EvidenceRound Round() const { return EvidenceRound::kFirst; }
  /// Null if it has nothing to say about the triplet.
  virtual std::unique_ptr<Evidence> Gather(
      const TripletView& triplet) const = 0;

  /// False if it is sure to have nothing to say about the triplet; a cheap
  /// answer that saves a test.
  virtual bool MaySpeak(const SceneFeatures& scene,
                        const ViewTriplet& views) const;
  /// The kind with what it needs of the scene for these triplets, computed
  /// once; null if it needs nothing. Errors: kCancelled.
  virtual Result<std::shared_ptr<const EvidenceKind>> Prepare(
      const SceneFeatures& scene, const std::vector<ViewTriplet>& triplets,
      const RunContext& context) const;
};

/// In the order of tables.
using EvidenceKinds = std::vector<std::shared_ptr<const EvidenceKind>>;

/// The evidence about one triplet, by kind.
struct TripletEvidence {
  struct OfKind {
    std::string name;
    std::shared_ptr<const Evidence> evidence;  // null: none
  };
  std::vector<OfKind> kinds;
  /// How often the triplet has been tested, this time included: more tests find
  /// more false ratios.
  int num_tests = 1;
};

/// Asks every kind about a triplet.
TripletEvidence GatherEvidence(const EvidenceKinds& kinds,
                               const TripletView& triplet);

}  // namespace lowlap
