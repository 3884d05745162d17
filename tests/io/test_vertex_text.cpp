// Text of files and names, made harmless for whoever reads it.
#include "io/text.hpp"
#include "io/vertex_text.hpp"
#include "support/bad_input.hpp"
#include "support/scratch.hpp"

#include <isostat/io/state_file.hpp>

using namespace isostat;
using scratch::replaced;

namespace {

/// Line 3 is disk 0, line 6 the box, line 7 the number of contacts, lines 8 to 13 the contacts.
const std::string two_disks = "# two disks\n2\n1 1 1 0.1 -1\n\n2 3.8284271247461903 2 0.2 -4\n5.8284271247461903 4\n6\n"
                              "0 1 0\n1 0 -1\n2 0 -1\n2 1 -1\n3 1 -1\n4 1 -1\n";

void refuses_vertex(const std::string& text, const std::vector<std::string>& words) {
    BOOST_TEST_INFO_SCOPE(text);
    expect_bad_input([&] { (void)parse_vertex_text(text, "v.txt"); }, words);
}

} // namespace

BOOST_AUTO_TEST_CASE(the_samples_have_as_many_contacts_as_degrees_of_freedom) {
    for (const int n : {100, 400, 1936}) {
        const State state = read_state(scratch::data("vertex" + std::to_string(n) + ".txt")).state;
        BOOST_TEST(state.packing.disk_count() == n);
        BOOST_TEST(state.contacts.size() == static_cast<std::size_t>(2 * n + 2));
        BOOST_TEST(state.load.infinitesimal.size() == static_cast<std::size_t>(2 * n));
        BOOST_TEST((state.load.kind == LoadKind::nominal));
        BOOST_TEST(state.load.stress[0] == 1.0);
        BOOST_TEST(state.load.stress[1] == 1.0);
        BOOST_TEST(state.load.reference_length[1] == state.packing.length(1));
        BOOST_TEST(std::ranges::is_sorted(state.contacts));
        for (const Contact& contact : state.contacts) {
            BOOST_TEST(std::abs(gap(state.packing, contact)) < 1e-13, to_string(contact));
        }
    }
}

BOOST_AUTO_TEST_CASE(rows_mean_what_the_format_says) {
    const State state = parse_vertex_text(two_disks, "v.txt");
    BOOST_TEST(state.packing.radius[1] == 2.0);
    BOOST_TEST(state.packing.q[3] == 2.0);
    BOOST_TEST(state.packing.length(1) == 4.0);
    BOOST_TEST(state.load.infinitesimal[3] == -4.0);
    const std::vector<Contact> expected{{ContactKind::disk_disk, 0, 1},  {ContactKind::lower_wall, 0, 0},
                                        {ContactKind::lower_wall, 0, 1}, {ContactKind::lower_wall, 1, 1},
                                        {ContactKind::upper_wall, 1, 0}, {ContactKind::upper_wall, 1, 1}};
    BOOST_TEST((state.contacts == expected));
}

BOOST_AUTO_TEST_CASE(names_after_the_number_of_disks_put_the_radius_last) {
    const std::string named = replaced(replaced(replaced(two_disks, "2\n1 1 1", "2 x y r gx gy\n1 1 1"),
                                                "2 3.8284271247461903 2 0.2", "3.8284271247461903 2 2 0.2"),
                                       "# two disks\n", "");
    const State state = parse_vertex_text(named, "v.txt"), old = parse_vertex_text(two_disks, "v.txt");
    BOOST_TEST((state.packing.radius == old.packing.radius));
    BOOST_TEST((state.packing.q == old.packing.q));
    BOOST_TEST((state.load.infinitesimal == old.load.infinitesimal));
    BOOST_TEST((state.contacts == old.contacts));
    refuses_vertex(replaced(named, "x y r gx", "x y d gx"), {"v.txt:1:", "'d'", "x y r gx gy"});
    refuses_vertex(replaced(named, " gy", ""), {"v.txt:1:", "x y r gx gy"});
    refuses_vertex(replaced(named, "1 1 1 0.1", "1 1 0 0.1"), {"v.txt:2:", "radius of disk 0", "'0'", "positive"});
}

BOOST_AUTO_TEST_CASE(bad_rows_are_named_with_their_line) {
    refuses_vertex(replaced(two_disks, "2\n1 1", "two\n1 1"), {"v.txt:2:", "number of disks", "'two'", "integer"});
    refuses_vertex(replaced(two_disks, "2\n1 1", "0\n1 1"), {"v.txt:2:", "'0'"});
    refuses_vertex(replaced(two_disks, "1 1 1 0.1", "0 1 1 0.1"), {"v.txt:3:", "radius of disk 0", "'0'", "positive"});
    refuses_vertex(replaced(two_disks, "1 1 1 0.1", "-1 1 1 0.1"),
                   {"v.txt:3:", "radius of disk 0", "'-1'", "positive"});
    refuses_vertex(replaced(two_disks, "1 1 1 0.1", "nan 1 1 0.1"),
                   {"v.txt:3:", "radius of disk 0", "'nan'", "finite"});
    refuses_vertex(replaced(two_disks, "1 1 1 0.1", "1 inf 1 0.1"), {"v.txt:3:", "x of disk 0", "'inf'", "finite"});
    refuses_vertex(replaced(two_disks, "1 1 1 0.1", "1 1 1x 0.1"), {"v.txt:3:", "y of disk 0", "'1x'"});
    refuses_vertex(replaced(two_disks, "1 1 1 0.1 -1", "1 1 1 0.1"),
                   {"v.txt:3:", "4 values", "5 values", "disk 0 of 2"});
    refuses_vertex(replaced(two_disks, " 4\n6", " 0\n6"), {"v.txt:6:", "Ly", "positive"});
    refuses_vertex(replaced(two_disks, "5.8284271247461903 4", "5.8284271247461903 3"),
                   {"v.txt", "disk 1", "larger than the box"});
    refuses_vertex(replaced(two_disks, "2 1 -1", "5 1 -1"), {"v.txt:11:", "type of the contact", "'5'", "from 0 to 4"});
    refuses_vertex(replaced(two_disks, "2 1 -1", "2 2 -1"), {"v.txt:11:", "first disk", "'2'", "from 0 to 1"});
    refuses_vertex(replaced(two_disks, "0 1 0\n", "0 1 1\n"), {"v.txt:8:", "second disk", "another disk"});
    refuses_vertex(replaced(two_disks, "2 1 -1", "2 0 -1"), {"0-bottom", "contacts[3]", "contacts[2]", "once"});
}

BOOST_AUTO_TEST_CASE(files_that_end_too_early_or_too_late_are_refused) {
    refuses_vertex("# nothing\n", {"v.txt:1:", "ends here", "number of disks"});
    refuses_vertex(replaced(two_disks, "4 1 -1\n", ""), {"ends here", "contact 5 of 6"});
    refuses_vertex(replaced(two_disks, "\n6\n", "\n5\n"), {"v.txt:13:", "more rows than announced"});
    for (std::size_t cut = 0; cut + 7 < two_disks.size(); ++cut) { // the last row is 7 characters long
        BOOST_CHECK_THROW((void)parse_vertex_text(two_disks.substr(0, cut), "v.txt"), Error);
    }
}

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
