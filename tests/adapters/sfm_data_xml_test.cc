#include "third_party_adapters/openmvg/internal/sfm_data_xml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "adapters/openmvg_vectors.h"
#include "third_party_adapters/openmvg/internal/sfm_data_bin.h"

namespace lowlap::openmvg {
namespace {

using ::testing::HasSubstr;

std::string TwoViewsXml() {
  const Result<std::string> xml = FormatSfmDataXml(TwoViews());
  EXPECT_TRUE(xml.has_value());
  return xml.value_or("");
}

std::string Replaced(std::string text, const std::string& from,
                     const std::string& to) {
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return text.replace(place, from.size(), to);
}

TEST(SfmDataXml, WritesTheLayoutOfCereal) {
  const std::string xml = TwoViewsXml();
  EXPECT_EQ(xml.rfind("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<cereal>\n"
                      "\t<sfm_data_version>0.3</sfm_data_version>\n"
                      "\t<root_path>/data/images</root_path>\n"
                      "\t<views size=\"dynamic\">\n\t\t<value0>\n"
                      "\t\t\t<key>0</key>\n",
                      0),
            0u)
      << xml;
  EXPECT_THAT(xml, HasSubstr("<local_path></local_path>"));
  EXPECT_THAT(xml, HasSubstr("\t<control_points size=\"dynamic\"/>\n"
                             "</cereal>\n\n"));
  EXPECT_THAT(xml, HasSubstr("<focal_length>500</focal_length>"));
  EXPECT_THAT(xml, HasSubstr("<disto_k3 size=\"dynamic\">\n"));
  EXPECT_THAT(xml, HasSubstr(">-0.10000000000000001</value0>"));
  EXPECT_THAT(xml,
              HasSubstr("\t\t\t\t<rotation size=\"dynamic\">\n"
                        "\t\t\t\t\t<value0 size=\"dynamic\">\n"
                        "\t\t\t\t\t\t<value0>0.80000000000000004</value0>\n"
                        "\t\t\t\t\t\t<value1>0</value1>\n"
                        "\t\t\t\t\t\t<value2>-0.59999999999999998</value2>\n"));
}

TEST(SfmDataXml, ReadingGivesTheSameSceneAsTheBinary) {
  const Result<Scene> scene = ParseSfmDataXml(TwoViewsXml());
  ASSERT_TRUE(scene.has_value()) << scene.error().ToString();
  EXPECT_TRUE(*scene == TwoViews());
}

TEST(SfmDataXml, KeepsEveryModelPriorAndSpecialCharacter) {
  Scene scene = *ParseSfmDataBin(FromHex(kAllModelsHex));
  for (std::uint32_t id = 0; id < 7; ++id) {
    View view = scene.views.at(0);
    view.filename = "0010";  // looks like a number
    view.local_path = " <a> & \"b\"'s ";
    view.intrinsic_id = id;
    scene.views[10 + id] = view;
  }
  scene.root_path = "Bücher/été";
  const Result<std::string> xml = FormatSfmDataXml(scene);
  ASSERT_TRUE(xml.has_value()) << xml.error().ToString();
  const Result<Scene> again = ParseSfmDataXml(*xml);
  ASSERT_TRUE(again.has_value()) << again.error().ToString();
  EXPECT_EQ(again->views.at(10).local_path, scene.views.at(10).local_path);
  EXPECT_TRUE(again->views == scene.views);
  EXPECT_TRUE(again->intrinsics == scene.intrinsics);
  EXPECT_TRUE(*again == scene);
}

TEST(SfmDataXml, EveryTruncationIsAnError) {
  const std::string xml = TwoViewsXml();
  // What follows the last '>' is white space.
  for (std::size_t size = 0; size + 2 < xml.size(); ++size) {
    ASSERT_FALSE(ParseSfmDataXml(xml.substr(0, size)).has_value()) << size;
  }
}

TEST(SfmDataXml, EveryDamagedByteIsSurvived) {
  const std::string xml = TwoViewsXml();
  int num_errors = 0;
  for (std::size_t n = 0; n < xml.size(); ++n) {
    for (const char byte : {'<', '\0', '&', '\xFF'}) {
      std::string damaged = xml;
      damaged[n] = byte;
      if (!ParseSfmDataXml(damaged)) ++num_errors;
    }
  }
  EXPECT_GT(num_errors, static_cast<int>(xml.size()));
}

TEST(SfmDataXml, MalformedContentIsNamed) {
  const auto error = [](const std::string& xml) {
    const Result<Scene> scene = ParseSfmDataXml(xml, "a.xml");
    EXPECT_FALSE(scene.has_value());
    return scene ? Error() : scene.error();
  };
  const std::string xml = TwoViewsXml();
  const Error number =
      error(Replaced(xml, "<value0>-3</value0>", "<value0>nan</value0>"));
  EXPECT_EQ(number.code, ErrorCode::kParse);
  EXPECT_THAT(number.message, HasSubstr("<value0> holds 'nan'"));
  EXPECT_EQ(number.place,
            "byte " + std::to_string(xml.find("<value0>-3</value0>") + 8));
  EXPECT_EQ(number.file, "a.xml");
  const Error text = error(Replaced(xml, "<key>0</key>", "<key>\"0\"</key>"));
  EXPECT_EQ(text.code, ErrorCode::kParse);
  const Error missing = error(Replaced(xml, "<width>640</width>\n", ""));
  EXPECT_EQ(missing.code, ErrorCode::kParse);
  EXPECT_THAT(missing.message + missing.place, HasSubstr("width"));
  const Error tag = error(Replaced(xml, "</views>", "</view>"));
  EXPECT_EQ(tag.code, ErrorCode::kParse);
  EXPECT_THAT(tag.message, HasSubstr("not XML"));
  EXPECT_EQ(
      error(Replaced(xml, "<sfm_data_version>0.3", "<sfm_data_version>7")).code,
      ErrorCode::kUnsupported);
  EXPECT_EQ(error("<other/>").code, ErrorCode::kParse);
  EXPECT_EQ(error("").code, ErrorCode::kParse);
  EXPECT_EQ(error(Replaced(xml, "<root_path>/", "<root_path>\xFF")).code,
            ErrorCode::kParse);
}

std::string Repeated(const std::string& part, int count) {
  std::string text;
  for (int n = 0; n < count; ++n) text += part;
  return text;
}

// The parser recurses: what hides a start tag or shows a false end tag, in
// comments, attributes and the like, must not deceive the count of the depth.
TEST(SfmDataXml, DeepNestingIsAnErrorAndNoCrash) {
  for (const char* part :
       {"<a>", "<a b=\"/>\">", "<a b='/>'>", "<a><!--</a>-->",
        "<a><![CDATA[</a>]]>", "<a><?x </a>?>", "<a b=\"</a>\">", "<a b='\"'>",
        "<a b = '>' >", "<a\n>", "<!-- > --><a>"}) {
    const Result<Scene> scene =
        ParseSfmDataXml("<cereal>" + Repeated(part, 80000));
    ASSERT_FALSE(scene.has_value()) << part;
    EXPECT_THAT(scene.error().message, HasSubstr("nested")) << part;
  }
}

// What a parser may take apart in more than one way is refused before it.
TEST(SfmDataXml, MalformedTagsAreRefusedAtTheFirst) {
  for (const char* part :
       {"<", "<a<b>", "<a x'=\"1\">", "<a b>", "<a b=c>", "<a\"b>", "< a>",
        "<!--", "<![CDATA[", "<?", "<!DOCTYPE [", "</a>"}) {
    const Result<Scene> scene = ParseSfmDataXml(Repeated(part, 1000000));
    ASSERT_FALSE(scene.has_value()) << part;
    EXPECT_EQ(scene.error().code, ErrorCode::kParse) << part;
    EXPECT_THAT(scene.error().message, HasSubstr("not XML")) << part;
    // At once, in the first two repetitions, or at the end of the text.
    const std::size_t byte = std::stoul(scene.error().place.substr(5));
    EXPECT_LE(byte, 2 * std::string(part).size() + 2) << part;
  }
}

TEST(SfmDataXml, CommentsDeclarationsAndAttributesChangeNothing) {
  const std::string xml = TwoViewsXml();
  const std::string commented = Replaced(
      Replaced(xml, "<cereal>", "<!DOCTYPE cereal><cereal note='a > b'>"),
      "\t<views", "<!-- <deep> </deep> --><?any <deep> ?>\t<views");
  const Result<Scene> scene = ParseSfmDataXml(commented);
  ASSERT_TRUE(scene.has_value()) << scene.error().ToString();
  EXPECT_TRUE(*scene == TwoViews());
}

TEST(SfmDataXml, WhatXmlCannotHoldIsNotWritten) {
  const auto with_root = [](const std::string& root_path) {
    Scene scene = TwoViews();
    scene.root_path = root_path;
    return scene;
  };
  for (const std::string& text :
       {std::string("a\0b", 3), std::string("\x01"), std::string("\x1F"),
        std::string("\xEF\xBF\xBF"), std::string("\xEF\xBF\xBE")}) {
    const Result<std::string> xml = FormatSfmDataXml(with_root(text));
    ASSERT_FALSE(xml.has_value());
    EXPECT_EQ(xml.error().code, ErrorCode::kInvalidScene);
  }
  for (const char* text : {"\r\n", "\na\n", "a\rb", "\t", "\x7F", "\xC2\x85"}) {
    const Result<std::string> xml = FormatSfmDataXml(with_root(text));
    ASSERT_TRUE(xml.has_value());
    const Result<Scene> again = ParseSfmDataXml(*xml);
    ASSERT_TRUE(again.has_value()) << again.error().ToString();
    EXPECT_EQ(again->root_path, text);
  }
}

}  // namespace
}  // namespace lowlap::openmvg
