#include "lowlap/io/internal/scene_binary.h"

#include <gtest/gtest.h>

#include "scene/example_scenes.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::FullScene;
using testing::IsError;
using testing::IsOk;

std::string FullSceneBytes() { return *FormatSceneBinary(FullScene()); }

std::uint64_t LittleEndian(const std::string& bytes, std::size_t offset,
                           int count) {
  std::uint64_t value = 0;
  for (int n = count - 1; n >= 0; --n) {
    value = value << 8 | static_cast<unsigned char>(bytes[offset + n]);
  }
  return value;
}

std::string Encoded(std::uint64_t value, int count) {
  std::string bytes;
  for (int n = 0; n < count; ++n) {
    bytes += static_cast<char>(value >> (8 * n));
  }
  return bytes;
}

// CRC-32 (ISO-HDLC) bit by bit, as FORMAT.md says.
std::uint32_t Crc32(const std::string& bytes) {
  std::uint32_t crc = 0xFFFFFFFFu;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc >> 1) ^ ((crc & 1) ? 0xEDB88320u : 0u);
    }
  }
  return ~crc;
}

// Where a section's header is: tag, checksum, length, payload.
std::size_t SectionOffset(const std::string& bytes, const std::string& tag) {
  std::size_t offset = 16;
  while (bytes.substr(offset, 4) != tag) {
    offset += 16 + LittleEndian(bytes, offset + 8, 8);
  }
  return offset;
}

// The file with another payload in one section, and the checksum to match.
std::string WithPayload(const std::string& bytes, const std::string& tag,
                        const std::string& payload) {
  const std::size_t begin = SectionOffset(bytes, tag);
  const std::size_t length = LittleEndian(bytes, begin + 8, 8);
  return bytes.substr(0, begin) + tag + Encoded(Crc32(payload), 4) +
         Encoded(payload.size(), 8) + payload +
         bytes.substr(begin + 16 + length);
}

std::string Payload(const std::string& bytes, const std::string& tag) {
  const std::size_t begin = SectionOffset(bytes, tag);
  return bytes.substr(begin + 16, LittleEndian(bytes, begin + 8, 8));
}

TEST(SceneBinary, LayoutOfTheHeader) {
  const std::string bytes = FullSceneBytes();
  EXPECT_EQ(bytes.substr(0, 8), "\x89LOWLAP\n");
  EXPECT_EQ(LittleEndian(bytes, 8, 4), 8u);
  EXPECT_EQ(LittleEndian(bytes, 12, 4), 18u);
  EXPECT_EQ(bytes.substr(16, 4), "ROOT");
  const std::string root = Payload(bytes, "ROOT");
  EXPECT_EQ(LittleEndian(root, 0, 8), FullScene().root_path.size());
  EXPECT_EQ(root.substr(8), FullScene().root_path);
  EXPECT_EQ(LittleEndian(bytes, 20, 4), Crc32(root));
}

TEST(SceneBinary, TruncationAtEveryByteIsAnError) {
  const std::string bytes = FullSceneBytes();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const Result<Scene> scene = ParseSceneBinary(bytes.substr(0, size), "f");
    ASSERT_FALSE(scene.has_value()) << size;
    ASSERT_EQ(scene.error().code, ErrorCode::kParse) << size;
    ASSERT_EQ(scene.error().file, "f");
    ASSERT_THAT(scene.error().place, ::testing::HasSubstr("byte ")) << size;
  }
}

TEST(SceneBinary, EveryFlippedBitIsAnError) {
  const std::string bytes = FullSceneBytes();
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string damaged = bytes;
      damaged[n] = static_cast<char>(damaged[n] ^ (1 << bit));
      ASSERT_FALSE(ParseSceneBinary(damaged).has_value())
          << "byte " << n << ", bit " << bit;
    }
  }
}

// As above, with checksums to match: the content's own checks have to hold.
TEST(SceneBinary, DamageBehindAMatchingChecksumNeverCrashes) {
  const Scene full = FullScene();
  const std::string bytes = FullSceneBytes();
  for (const char* tag :
       {"ROOT", "VIEW", "INTR", "POSE", "STRU", "CTRL", "FEAT", "RELP", "PTRK",
        "LTRK", "RATI", "LINE", "COPL", "UNRE"}) {
    const std::string payload = Payload(bytes, tag);
    for (std::size_t n = 0; n < payload.size(); ++n) {
      for (const char byte : {'\x00', '\x01', '\x7F', '\xFF'}) {
        std::string damaged = payload;
        if (damaged[n] == byte) continue;
        damaged[n] = byte;
        const Result<Scene> scene =
            ParseSceneBinary(WithPayload(bytes, tag, damaged));
        if (scene) {
          ASSERT_FALSE(*scene == full) << tag << " " << n;
        }
      }
      ASSERT_FALSE(
          ParseSceneBinary(WithPayload(bytes, tag, payload.substr(0, n)))
              .has_value())
          << tag << " " << n;
    }
    EXPECT_THAT(ParseSceneBinary(WithPayload(bytes, tag, payload + '\0')),
                IsError(ErrorCode::kParse, "the section is too long"));
  }
}

TEST(SceneBinary, HugeLengthsAllocateNothing) {
  const std::string bytes = FullSceneBytes();
  for (const std::uint64_t length :
       {std::uint64_t{1} << 32, std::uint64_t{1} << 60, ~std::uint64_t{0}}) {
    for (const char* tag :
         {"ROOT", "VIEW", "STRU", "FEAT", "RELP", "RATI", "COPL"}) {
      EXPECT_THAT(ParseSceneBinary(WithPayload(bytes, tag, Encoded(length, 8))),
                  IsError(ErrorCode::kParse, "exceeds the bytes that are left"))
          << tag;
    }
  }
}

TEST(SceneBinary, ForeignAndNewerFiles) {
  std::string bytes = FullSceneBytes();
  EXPECT_THAT(ParseSceneBinary(""),
              IsError(ErrorCode::kParse, "not a .lowlap file"));
  EXPECT_THAT(ParseSceneBinary("{\"sfm_data_version\": \"0.3\"}"),
              IsError(ErrorCode::kParse, "not a .lowlap file"));
  EXPECT_THAT(ParseSceneBinary(bytes + "x"),
              IsError(ErrorCode::kParse, "follows the last section"));
  bytes[8] = 9;
  EXPECT_THAT(ParseSceneBinary(bytes, "new.lowlap"),
              IsError(ErrorCode::kUnsupported,
                      "new.lowlap: byte 8: version 9 is not 2 to 8"));
}

TEST(SceneBinary, CovariancesAreOfPoses) {
  const std::string bytes = FullSceneBytes();
  std::string payload = Payload(bytes, "CCOV");
  ASSERT_EQ(LittleEndian(payload, 8, 4), 101u);
  payload[8] = 99;
  EXPECT_THAT(ParseSceneBinary(WithPayload(bytes, "CCOV", payload)),
              IsError(ErrorCode::kInvalidScene, "there is no pose 99"));
}

TEST(SceneBinary, WeaknessesAreKnownOnes) {
  const std::string bytes = FullSceneBytes();
  std::string payload = Payload(bytes, "WEAK");
  ASSERT_EQ(payload, std::string("\1\1\0", 3));
  payload[1] = 2;
  const auto scene = ParseSceneBinary(WithPayload(bytes, "WEAK", payload));
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->relative_poses.begin()->second.weakness,
            PoseWeakness::kRepeats);
  payload[1] = 3;
  EXPECT_THAT(ParseSceneBinary(WithPayload(bytes, "WEAK", payload)),
              IsError(ErrorCode::kParse, "section WEAK"));
}

// Of views 1, 4, 7, and 10: the numbers of points and of segments, and each.
TEST(SceneBinary, RepeatedFeaturesAreThoseOfTheirViews) {
  const std::string bytes = FullSceneBytes();
  std::string payload = Payload(bytes, "REPT");
  ASSERT_EQ(payload.size(), 8u * 8 + 4 * 4);
  ASSERT_EQ(LittleEndian(payload, 16, 8), 3u);
  payload[24 + 8] = 6;
  EXPECT_THAT(ParseSceneBinary(WithPayload(bytes, "REPT", payload)),
              IsError(ErrorCode::kInvalidScene, "repeated_points[2]"));
  payload[16] = 100;
  EXPECT_THAT(ParseSceneBinary(WithPayload(bytes, "REPT", payload)),
              IsError(ErrorCode::kParse, "section REPT"));
}

TEST(SceneBinary, DamageIsLocated) {
  std::string bytes = FullSceneBytes();
  const std::size_t offset = SectionOffset(bytes, "FEAT");
  bytes[offset + 40] ^= 1;
  EXPECT_THAT(ParseSceneBinary(bytes),
              IsError(ErrorCode::kParse, "section FEAT is damaged"));
}

TEST(SceneBinary, RepeatedIdsAreAnError) {
  const std::string bytes = FullSceneBytes();
  // Two line tracks: the id of the second becomes that of the first.
  std::string payload = Payload(bytes, "LTRK");
  ASSERT_EQ(LittleEndian(payload, 0, 8), 2u);
  const std::size_t second = 8 + 4 + 8 + 3 * 8;
  ASSERT_EQ(LittleEndian(payload, second, 4), 3u);
  payload[second] = 2;
  EXPECT_THAT(ParseSceneBinary(WithPayload(bytes, "LTRK", payload)),
              IsError(ErrorCode::kParse, "ids must ascend"));
}

TEST(SceneBinary, InvalidContentHasItsJsonPath) {
  const std::string bytes = FullSceneBytes();
  std::string payload = Payload(bytes, "COPL");
  payload[8] = 77;
  EXPECT_THAT(ParseSceneBinary(WithPayload(bytes, "COPL", payload), "f"),
              IsError(ErrorCode::kInvalidScene,
                      "f: $.lowlap.coplanar_pairs[0]: there is no line 77"));
}

}  // namespace
}  // namespace lowlap
