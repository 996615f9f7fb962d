#include "files/message_text.h"

#include "support/matchers.h"

namespace robot_control::tests {

TEST(MessageText, EscapesControlCharactersAndWhatIsNoUtf8) {
  EXPECT_EQ(printable(std::string_view("a\0b\x1b[2J\x7f", 8)), R"(a\x00b\x1b[2J\x7f)");
  EXPECT_EQ(printable("N·m \xff \xc2\x9b"), "N·m \\xff \\xc2\\x9b");
}

TEST(MessageText, EchoesAtMostTwoHundredCharactersAndCutsBetweenThem) {
  EXPECT_EQ(printable(std::string(200, 'x')), std::string(200, 'x'));
  EXPECT_EQ(printable(std::string(201, 'x')), std::string(200, 'x') + "…");
  EXPECT_EQ(printable("ab·", 3), "ab…");
}

TEST(MessageText, CutsEveryLongWordOfASentence) {
  const std::string text = fit_for_message("there is no " + std::string(100'000, 'n') + ", so nothing\nis read");
  EXPECT_EQ(text, "there is no " + std::string(200, 'n') + "… so nothing\nis read");
}

TEST(MessageText, CutsEveryLongQuotedPartOfASentence) {
  std::string many;
  for (int i = 0; i < 1000; ++i) many += "word ";
  const std::string text = fit_for_message("joint \"" + many + "\" is not there");
  EXPECT_LT(text.size(), 230u);
  EXPECT_THAT(text, HasSubstr("… is not there"));
}

TEST(MessageText, BoundsTheSentenceAsAWhole) {
  std::string many;
  for (int i = 0; i < 10'000; ++i) many += "word ";
  EXPECT_LT(fit_for_message(many).size(), kMaxSentence + 2 * kMaxEcho);
  EXPECT_THAT(fit_for_message(std::string("a\0b \x1b", 5)), Not(HasSubstr("\x1b")));
}

}  // namespace robot_control::tests
