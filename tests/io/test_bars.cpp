// Bars in state files.
#include "support/clumps.hpp"
#include "support/test.hpp"

#include <isostat/core/error.hpp>

using namespace isostat;

namespace {

std::string state_with(const std::string& bars, const std::string& contacts) {
    return R"({"format": "isostat-state", "version": 2, "length": [4, 2], "disks": [[1, 1, 1], [3, 1, 1]], "bars": )" +
           bars + R"(, "contacts": )" + contacts + "}";
}

} // namespace

BOOST_AUTO_TEST_CASE(bars_come_back_bit_for_bit_and_close_the_list_of_contacts) {
    const State state = isostat::test::clumps_of(state_with(R"([[0, 1, "0x1.0000000000001p1"]])", R"([[0, "left"]])"));
    BOOST_TEST(state.packing.bars.size() == 1U);
    BOOST_TEST(state.packing.bars[0].length == 0x1.0000000000001p1);
    BOOST_TEST_REQUIRE(state.contacts.size() == 2U);
    BOOST_TEST((state.contacts[1] == isostat::Contact{ContactKind::bar, 0, 1}));
    const State again = isostat::test::clumps_of(isostat::state_text(state));
    BOOST_TEST((again.packing.bars == state.packing.bars));
    BOOST_TEST((again.contacts == state.contacts));
}

BOOST_AUTO_TEST_CASE(bars_that_a_state_cannot_have_are_refused) {
    const auto refused = [](const std::string& bars, const std::string& contacts) {
        BOOST_TEST_INFO_SCOPE(bars << " " << contacts);
        BOOST_CHECK_THROW((void)isostat::test::clumps_of(state_with(bars, contacts)), Error);
    };
    for (const char* const bars :
         {"[[0, 2, 1]]", "[[1, 0, 1]]", "[[0, 0, 1]]", "[[0, 1]]", "[[0, 1, 0]]", "[[0, 1, -1]]", "[[0, 1, \"nan\"]]",
          "[[0, 1, 1], [0, 1, 2]]", "[[0, 1, 1e999]]", "[[0.5, 1, 1]]", "{\"0\": 1}", "7"}) {
        refused(bars, "[]");
    }
    refused("[[0, 1, 2]]", R"([["bar", 1, 0]])");
    refused("[[0, 1, 2]]", R"([["bar", 0, 1], ["bar", 0, 1]])");
    refused("[[0, 1, 2]]", R"([["bar", 0, 2]])");
    refused("[]", R"([["bar", 0, 1]])");
}

BOOST_AUTO_TEST_CASE(bodies_bounded_by_arcs_come_back_and_are_taken_only_where_they_are_asked_for) {
    const State state = isostat::test::oval_in_a_box(1, 1);
    BOOST_TEST((state.packing.arcs == std::vector<std::vector<int>>{{0, 1, 2, 3}}));
    const std::string text = isostat::state_text(state);
    BOOST_TEST((isostat::test::clumps_of(text).packing.arcs == state.packing.arcs));
    for (const Dimensions taken : {Dimensions::two, Dimensions::any, Dimensions::any_clumps}) {
        BOOST_CHECK_THROW((void)isostat::parse_any_state(text, "ovals", taken), Error);
    }
    for (const char* const other : {"[[0, 1, 2]]", "[[0, 1, 2, 4]]", "[[0, 1, 2, 2.5]]", "[0, 1, 2, 3]",
                                    "[[3, 2, 1, 0]]", "{}", "[[0, 1, 2, -1]]"}) {
        std::string spoilt = text;
        const std::size_t begin = spoilt.find("\"arcs\": [") + 8;
        const std::size_t end = spoilt.find("]\n  ]", begin) + 5;
        spoilt.replace(begin, end - begin, other);
        BOOST_CHECK_THROW((void)isostat::test::clumps_of(spoilt), Error);
        BOOST_TEST_INFO(other);
    }
}

BOOST_AUTO_TEST_CASE(what_takes_single_grains_refuses_clumps) {
    const std::string text = state_with("[[0, 1, 2]]", "[]");
    BOOST_CHECK_THROW((void)isostat::parse_any_state(text, "clumps", Dimensions::any), Error);
    BOOST_CHECK_THROW((void)isostat::parse_state(text, "clumps"), Error);
    BOOST_CHECK_NO_THROW((void)isostat::parse_any_state(text, "clumps", Dimensions::any_clumps));
}
