// Words of enums.
#include "core/work.hpp"
#include "packing/words.hpp"

#include <isostat/core/result.hpp>

#include <boost/test/unit_test.hpp>

#include <set>
#include <stdexcept>
#include <string>

BOOST_AUTO_TEST_SUITE(core)

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

BOOST_AUTO_TEST_SUITE_END()
