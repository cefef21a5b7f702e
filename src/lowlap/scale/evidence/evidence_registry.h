#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/scale/evidence/evidence_kind.h"

namespace lowlap {

/// The kinds of evidence that options and the command line can name. A program
/// of one's own may add to the built-in ones.
class EvidenceRegistry {
 public:
  struct Entry {
    /// Of the kind.
    std::string name;
    /// The word that asks for it; kinds of one word are asked for together.
    std::string feature;
    /// For people.
    std::string help;
    /// A flag of the command line that turns the kind on or off among those of
    /// its word; empty: none.
    std::string flag;
    std::function<std::shared_ptr<const EvidenceKind>()> make;
  };

  static const EvidenceRegistry& BuiltIn();

  /// Replaces an entry of the same name.
  void Add(Entry entry);
  const std::vector<Entry>& entries() const { return entries_; }
  /// The words, each once, in the order of the entries.
  std::vector<std::string> Features() const;

  /// The kinds of the given words (all if there are none), in the order of the
  /// entries, without those named in `without`.
  /// kInvalidArgument: an unknown word or name, no kind left.
  Result<EvidenceKinds> Make(const std::vector<std::string>& features,
                             const std::vector<std::string>& without) const;

 private:
  std::vector<Entry> entries_;
};

}  // namespace lowlap
