// Text of files and names, made harmless for whoever reads it.
#include "io/text.hpp"
#include "support/test.hpp"

using namespace isostat;

BOOST_AUTO_TEST_CASE(control_characters_and_bytes_that_are_not_utf8_are_shown) {
    BOOST_TEST(text::shown("a\x1b[2J\a\n\r\t\x7f"
                           "b") == "a\\x1b[2J\\x07\\x0a\\x0d\\x09\\x7fb");
    BOOST_TEST(text::shown(std::string("\0", 1)) == "\\x00");
    BOOST_TEST(text::shown("\xC2\x9B"
                           "31m") == "\\x9b31m"); // CSI of C1, in UTF-8
    BOOST_TEST(text::shown("\x9B"
                           "31m") == "\\x9b31m"); // and as a byte
    for (const char* wrong : {"\xC3", "\xC0\xAF", "\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xFF"}) {
        const std::string shown = text::shown(wrong);
        BOOST_TEST(shown.starts_with("\\x"), shown);
        BOOST_TEST(shown.find_first_not_of("\\x0123456789abcdef") == std::string::npos, shown);
    }
    BOOST_TEST(text::shown("\u202etxt.exe\u2028") == "\\u202etxt.exe\\u2028");
    for (const char* plain : {"", "σ₂ = 1", "back \\ slash", "\U0001F600", "a`b'\"$(c)"}) {
        BOOST_TEST(text::shown(plain) == plain);
        BOOST_TEST(text::is_plain_line(plain));
    }
    BOOST_TEST(!text::is_plain_line("two\nlines"));
    BOOST_TEST(text::shown_lines("two\nlines\x1b") == "two\nlines\\x1b");
}

BOOST_AUTO_TEST_CASE(each_language_keeps_foreign_text_as_text) {
    BOOST_TEST(text::gnuplot("`touch x` it's \"\\\n") == R"("\140touch x\140 it\047s \042\134\134x0a")");
    BOOST_TEST(text::csv("plain words") == "plain words");
    BOOST_TEST(text::csv("a,b \"c\"\n") == "\"a,b \"\"c\"\"\\x0a\"");
    BOOST_TEST(text::csv("=cmd|'/c calc'!A1") == "'=cmd|'/c calc'!A1");
    BOOST_TEST(text::markup("<a href='x\">&") == "&lt;a href=&#39;x&quot;&gt;&amp;");
    BOOST_TEST(text::man(".so /etc/passwd\n'a -b \\fB") == "\\&.so /etc/passwd\n\\&'a \\-b \\efB");
    BOOST_TEST(text::shell("it's $(x)") == "'it'\\''s $(x)'");
    BOOST_TEST(text::shell("") == "''");
    BOOST_TEST(text::shell("a/b-1.json") == "a/b-1.json");
    BOOST_TEST(text::json("{\n\"a\": \"\x7f\xC2\x9B σ\"}") == "{\n\"a\": \"\\u007f\\u009b σ\"}");
    BOOST_TEST(text::in_script(R"({"a": "</script><!--&"})") == R"({"a": "\u003c/script\u003e\u003c!--\u0026"})");
}
