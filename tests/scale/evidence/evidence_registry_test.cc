#include "lowlap/scale/evidence/evidence_registry.h"

#include <gmock/gmock.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Named : public EvidenceKind {
 public:
  explicit Named(std::string name) : name_(std::move(name)) {}
  std::string Name() const override { return name_; }
  std::unique_ptr<Evidence> Gather(const TripletView&) const override {
    return nullptr;
  }

 private:
  std::string name_;
};

EvidenceRegistry::Entry EntryOf(const std::string& name,
                                const std::string& feature) {
  return {name, feature, "help", "",
          [name] { return std::make_shared<Named>(name); }};
}

std::vector<std::string> Names(const Result<EvidenceKinds>& kinds) {
  std::vector<std::string> names;
  for (const auto& kind : kinds.value()) names.push_back(kind->Name());
  return names;
}

TEST(EvidenceRegistry, EveryEntryMakesTheKindOfItsName) {
  std::vector<std::string> names;
  for (const auto& entry : EvidenceRegistry::BuiltIn().entries()) {
    EXPECT_EQ(entry.make()->Name(), entry.name);
    names.push_back(entry.name);
  }
  EXPECT_THAT(names, ::testing::Not(::testing::IsEmpty()));
  EXPECT_EQ(Names(EvidenceRegistry::BuiltIn().Make({}, {})), names);
}

TEST(EvidenceRegistry, MakesTheKindsOfTheWordsInItsOwnOrder) {
  EvidenceRegistry registry;
  registry.Add(EntryOf("corners", "points"));
  registry.Add(EntryOf("wheels", "odometry"));
  registry.Add(EntryOf("blobs", "points"));
  EXPECT_THAT(registry.Features(), ElementsAre("points", "odometry"));
  EXPECT_THAT(Names(registry.Make({"odometry", "points"}, {})),
              ElementsAre("corners", "wheels", "blobs"));
  EXPECT_THAT(Names(registry.Make({"points"}, {})),
              ElementsAre("corners", "blobs"));
  EXPECT_THAT(Names(registry.Make({}, {"corners"})),
              ElementsAre("wheels", "blobs"));
}

TEST(EvidenceRegistry, ReplacesAnEntryOfTheSameName) {
  EvidenceRegistry registry;
  registry.Add(EntryOf("wheels", "odometry"));
  registry.Add(EntryOf("wheels", "distance"));
  EXPECT_EQ(registry.entries().size(), 1u);
  EXPECT_THAT(registry.Features(), ElementsAre("distance"));
}

TEST(EvidenceRegistry, UnknownWordsAndNoKindsAreErrors) {
  EvidenceRegistry registry;
  registry.Add(EntryOf("wheels", "odometry"));
  registry.Add(EntryOf("blobs", "points"));
  EXPECT_THAT(registry.Make({"colours"}, {}).error().message,
              HasSubstr("'colours'; known: odometry, points"));
  EXPECT_THAT(registry.Make({}, {"colours"}).error().message,
              HasSubstr("'colours'"));
  EXPECT_THAT(registry.Make({"odometry"}, {"wheels"}).error().message,
              HasSubstr("no kind"));
}

}  // namespace
}  // namespace lowlap
