// Words of enums.
// A result without a value is never read as one, in any build.
#include "core/work.hpp"
#include "packing/words.hpp"
#include "support/test.hpp"

#include <isostat/core/result.hpp>

#include <boost/test/unit_test.hpp>

#include <memory>
#include <set>
#include <stdexcept>
#include <string>

using namespace isostat;

namespace {

Result<std::unique_ptr<int>> half(int number) {
    if (number % 2 != 0) {
        return Failure{FailureKind::undecided, "3 is odd"};
    }
    return std::make_unique<int>(number / 2);
}

template <class Action> std::string thrown(Action action) {
    try {
        action();
    } catch (const std::logic_error& error) {
        return error.what();
    }
    return "nothing was thrown";
}

} // namespace

BOOST_AUTO_TEST_CASE(a_word_leads_to_its_value_and_back_and_no_other_word_to_any) {
    using namespace isostat;
    for (const WallKind kind : {WallKind::absent, WallKind::fixed, WallKind::movable}) {
        BOOST_TEST((value_of(word_of(kind, wall_kind_words), wall_kind_words) == kind));
    }
    BOOST_TEST(word_of(LoadKind::true_stress, load_kind_words) == std::string("true"));
    for (const char* other : {"", "Fixed", "fix", "fixed ", "nominal"}) {
        BOOST_TEST(!value_of(other, wall_kind_words).has_value(), other);
    }
    BOOST_CHECK_THROW((void)word_of(static_cast<WallKind>(3), wall_kind_words), std::out_of_range);
    BOOST_TEST(listed(wall_kind_words) == "\"absent\", \"fixed\" or \"movable\"");
}

BOOST_AUTO_TEST_CASE(a_value_without_a_name_is_no_enumerator) {
    using namespace isostat;
    enum class One : unsigned char { only };
    static_assert(is_enumerator<One::only>() && !is_enumerator<static_cast<One>(1)>());
    static_assert(is_enumerator<Work::vtk_files>() && !is_enumerator<static_cast<Work>(work_kinds)>());
    BOOST_TEST(is_enumerator<WallKind::movable>());
    BOOST_TEST(!is_enumerator<static_cast<WallKind>(3)>());
}

BOOST_AUTO_TEST_CASE(every_kind_of_work_and_of_failure_has_a_word_of_its_own) {
    using namespace isostat;
    std::set<std::string> words;
    for (std::size_t k = 0; k < work_kinds; ++k) {
        words.insert(to_string(static_cast<Work>(k)));
    }
    BOOST_TEST(words.size() == work_kinds);
    BOOST_TEST(to_string(Work::vtk_files) == std::string("vtk_files"));
    BOOST_TEST(to_string(FailureKind::flows) == std::string("flows"));
    BOOST_TEST(to_string(FailureKind::interrupted) == std::string("interrupted"));
}

BOOST_AUTO_TEST_CASE(a_result_gives_what_it_has) {
    auto four = half(8);
    BOOST_TEST(four.ok());
    BOOST_TEST(*four.value() == 4);
    const auto none = half(3);
    BOOST_TEST(!none.ok());
    BOOST_TEST((none.failure().kind == FailureKind::undecided));
}

BOOST_AUTO_TEST_CASE(the_value_of_a_failure_throws_and_says_why_there_is_none) {
    auto none = half(3);
    const auto& constant = none;
    BOOST_TEST(thrown([&] { (void)none.value(); }).ends_with("undecided: 3 is odd"));
    BOOST_TEST(thrown([&] { (void)constant.value(); }).ends_with("undecided: 3 is odd"));
}

BOOST_AUTO_TEST_CASE(the_failure_of_a_value_throws) {
    const auto four = half(8);
    BOOST_TEST(thrown([&] { (void)four.failure(); }) == "the failure of a result was asked for, which has a value");
}

BOOST_AUTO_TEST_CASE(words_are_put_together_when_they_are_asked_for) {
    int asked = 0;
    Words why([&asked](int) { return "after " + std::to_string(++asked); });
    why.contacts = {{ContactKind::disk_disk, 1, 2}};
    const Failure inner{FailureKind::overlap, why};
    Words place("arc 3");
    place.disks = {7};
    const Failure outer = located(inner, place);
    BOOST_TEST(asked == 0);
    BOOST_TEST(outer.message() == "arc 3: after 1");
    BOOST_TEST((outer.kind == FailureKind::overlap));
    BOOST_TEST((outer.contacts() == std::vector<Contact>{{ContactKind::disk_disk, 1, 2}}));
    BOOST_TEST(outer.disks() == std::vector<int>{7});
    BOOST_TEST(Words().empty());
    BOOST_TEST(Words("").empty());
    BOOST_TEST(Words().text().empty());
}
