// The smallest of several quantities by comparisons that may be open, wrong at first guess, or contradictory.
#include "statics/proved_minimum.hpp"
#include "support/test.hpp"

using namespace isostat;

namespace {

constexpr const char* contradiction = "they contradict each other";

/// Numbers; equal ones are ties. `turning`: each is proved smaller than the one before it, round and round.
class Numbers final : public Contest {
  public:
    explicit Numbers(std::vector<double> x, bool turning = false) : x_(std::move(x)), turning_(turning) {}
    [[nodiscard]] std::size_t size() const override { return x_.size(); }
    Result<std::optional<std::size_t>> stand(std::size_t best) override {
        ++stood;
        return std::isnan(x_[best]) ? std::optional<std::size_t>() : std::optional(best);
    }
    Result<Comparison> compare(std::size_t rival, std::size_t best) override {
        if (turning_) {
            return by_order({true, rival == (best + 1) % x_.size() ? -1 : 1, 1, Rung::exact}, [] { return Words(); });
        }
        const double d = x_[rival] - x_[best];
        return by_order({d != 0, d < 0 ? -1 : 1, std::abs(d), Rung::exact},
                        [&] { return Words("; " + std::to_string(rival)); });
    }
    int stood = 0;

  private:
    std::vector<double> x_;
    bool turning_;
};

Minimum minimum_of(Numbers& numbers, std::size_t first) {
    return required(proved_minimum(numbers, first, contradiction));
}

} // namespace

BOOST_AUTO_TEST_CASE(whoever_is_proved_smaller_takes_the_place_of_a_wrong_guess) {
    for (std::size_t first = 0; first < 4; ++first) {
        Numbers numbers({3, 5, 1, 2});
        const Minimum minimum = minimum_of(numbers, first);
        BOOST_TEST((minimum.index == 2U));
        BOOST_TEST(minimum.tied.empty());
        BOOST_TEST(minimum.margin == 1); // of the nearest, 2
        BOOST_TEST((minimum.rung == Rung::exact));
    }
}

BOOST_AUTO_TEST_CASE(only_ties_with_the_smallest_are_told) {
    Numbers above({5, 1, 5});
    BOOST_TEST(minimum_of(above, 0).tied.empty());
    Numbers below({5, 1, 1, 1});
    const Minimum minimum = minimum_of(below, 0);
    BOOST_TEST((minimum.index == 1U));
    BOOST_TEST(minimum.tied.text() == "; 2; 3");
}

BOOST_AUTO_TEST_CASE(there_is_no_minimum_where_nobody_can_stand) {
    Numbers nobody({std::nan(""), 1});
    BOOST_TEST(!minimum_of(nobody, 0).index);
}

BOOST_AUTO_TEST_CASE(comparisons_that_contradict_each_other_end_undecided) {
    Numbers round({1, 1, 1}, true);
    BOOST_TEST(fails(proved_minimum(round, 0, contradiction), FailureKind::undecided).message() == contradiction);
    BOOST_TEST(round.stood == 4);
}
