// What is known at the start of an arc, and what an arc hands on to the next.
#include "motion/arc.hpp"
#include "motion/chord.hpp"
#include "support/test.hpp"

#include <isostat/io/state_file.hpp>

using namespace isostat;

namespace {

/// Any contact may open, not only one that a load drives apart.
State unloaded(State state) {
    state.load.stress.fill(0);
    return state;
}

/// The vertex of a file, and the arcs that open its contacts.
struct Start {
    State state = unloaded(read_state(std::string(ISOSTAT_TEST_DATA) + "/vertex100.txt").state);
    IsostaticStructure structure = IsostaticStructure::prove(state.packing, state.contacts).value();
    Factorisation factorisation{structure};
    CandidateList candidates = find_candidates(state.packing, candidate_fraction);

    [[nodiscard]] ArcDeparture depart(std::size_t slot, std::vector<Contact> open = {}) {
        return {{state.packing, structure, factorisation, ContactId(slot)},
                {&state.load, false, false},
                candidates,
                ArcOptions{},
                std::move(open)};
    }
};

/// By definition.
std::vector<Contact> candidates_without(const CandidateList& candidates, const std::vector<Contact>& contacts) {
    std::vector<Contact> open;
    std::ranges::copy_if(candidates.contacts, std::back_inserter(open),
                         [&](const Contact& c) { return std::ranges::find(contacts, c) == contacts.end(); });
    return open;
}

/// Iterations until x <- x + y(x), y = A (1 - x) with eigenvalues of 1 - A as given, is at its fixed point.
int iterations(const std::vector<double>& rates, bool accelerated, double curvature = 0.01) {
    std::vector<double> x(rates.size(), 0.0);
    std::vector<double> y(rates.size());
    Acceleration acceleration;
    for (int k = 1; k < 1000; ++k) {
        double size = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            y[i] = (1 - rates[i]) * (1 - x[i]) + curvature * (1 - x[i]) * (1 - x[i]);
            size = std::max(size, std::abs(y[i]));
        }
        if (size < 1e-13) {
            return k;
        }
        if (accelerated) {
            acceleration.improve(y);
        }
        for (std::size_t i = 0; i < x.size(); ++i) {
            x[i] += y[i];
        }
    }
    return 1000;
}

} // namespace

BOOST_AUTO_TEST_CASE(an_arc_hands_on_the_candidates_that_are_open_at_its_end) {
    Start start;
    int followed = 0;
    for (std::size_t slot = 0; slot < start.state.contacts.size(); slot += 3) {
        const auto arc = start.depart(slot).follow();
        if (!arc.ok()) {
            continue;
        }
        std::vector<Contact> contacts = start.state.contacts;
        contacts[slot] = arc.value().closed;
        const bool same = arc.value().open == candidates_without(start.candidates, contacts);
        BOOST_TEST(same, "slot " << slot);
        ++followed;
    }
    BOOST_TEST(followed > 20);
}

BOOST_AUTO_TEST_CASE(open_candidates_at_hand_do_not_change_an_arc) {
    Start start;
    const std::vector<Contact> open = candidates_without(start.candidates, start.state.contacts);
    int followed = 0;
    for (std::size_t slot = 0; slot < start.state.contacts.size(); slot += 3) {
        const auto arc = start.depart(slot).follow();
        const auto again = start.depart(slot, open).follow();
        BOOST_TEST_REQUIRE(arc.ok() == again.ok());
        if (arc.ok()) {
            BOOST_TEST((arc.value().end.q == again.value().end.q));
            BOOST_TEST((arc.value().closed == again.value().closed));
            BOOST_TEST((arc.value().open == again.value().open));
            ++followed;
        }
    }
    BOOST_TEST(followed > 20);
}

BOOST_AUTO_TEST_CASE(the_expected_end_is_mostly_the_end_and_never_decides_it) {
    Start start;
    int right = 0, wrong = 0;
    for (std::size_t slot = 0; slot < start.state.contacts.size(); ++slot) {
        ArcDeparture departure = start.depart(slot);
        const auto expected = departure.expected();
        const auto arc = departure.follow();
        if (!arc.ok() || !expected) {
            continue;
        }
        if (arc.value().closed != expected->closes) {
            ++wrong;
            continue;
        }
        ++right;
        double moved = 0, off = 0;
        for (std::size_t k = 0; k < arc.value().end.q.size(); ++k) {
            moved = std::max(moved, std::abs(arc.value().end.q[k] - start.state.packing.q[k]));
            off = std::max(off, std::abs(arc.value().end.q[k] - expected->end.q[k]));
        }
        BOOST_TEST(off < 0.1 * moved);
    }
    BOOST_TEST_MESSAGE(right << " expected, " << wrong << " not");
    BOOST_TEST(right > 10 * wrong);
    BOOST_TEST(right > 50);
}

BOOST_AUTO_TEST_CASE(an_exchange_does_not_depend_on_the_guess_of_it) {
    Start start;
    int predicted = 0;
    for (std::size_t slot = 0; slot < start.state.contacts.size(); slot += 5) {
        ArcDeparture departure = start.depart(slot);
        const auto expected = departure.expected();
        const auto arc = departure.follow();
        if (!arc.ok() || !expected) {
            continue;
        }
        const auto exchange = [&](const Packing& at, const Contact& closes, const ExchangedContacts* guess = nullptr) {
            return IsostaticStructure::exchange(start.structure, at, ContactId(slot), closes, guess);
        };
        const auto plain = required(exchange(arc.value().end, arc.value().closed));
        BOOST_TEST(!plain.predicted());
        // The same exchange nearby, and another one.
        const auto near = exchange(expected->end, arc.value().closed);
        const auto other = exchange(arc.value().end, start.state.contacts[slot]);
        for (const auto* guess : {&near, &other}) {
            BOOST_TEST_REQUIRE(guess->has_value());
            const auto guessed = required(exchange(arc.value().end, arc.value().closed, &**guess));
            BOOST_TEST((guessed.contacts() == plain.contacts()));
            BOOST_TEST((guessed.matrix().value == plain.matrix().value));
            BOOST_TEST((guessed.matching() == plain.matching()));
            BOOST_TEST(guessed.predicted() == (guess == &near));
            predicted += guessed.predicted() ? 1 : 0;
        }
    }
    BOOST_TEST(predicted > 10);
}

BOOST_AUTO_TEST_CASE(few_slow_directions_cost_few_iterations_when_accelerated) {
    std::vector<double> rates(200, 0.01);
    rates[17] = 0.5;
    rates[90] = -0.4;
    const int plain = iterations(rates, false);
    const int accelerated = iterations(rates, true);
    BOOST_TEST(plain > 25);
    BOOST_TEST(accelerated < plain / 2);
}

// Each change removes one of the rates, as each direction of a Krylov method does.
BOOST_AUTO_TEST_CASE(a_linear_iteration_with_three_rates_ends_after_three_changes) {
    for (const double slow : {0.3, 0.6, 0.9}) {
        std::vector<double> rates(30, 0.01);
        rates[3] = slow;
        rates[20] = -0.7 * slow;
        BOOST_TEST(iterations(rates, true, 0) <= 6, "rate " << slow << ": " << iterations(rates, true, 0));
    }
}

BOOST_AUTO_TEST_CASE(changes_that_repeat_each_other_do_no_harm) {
    for (std::size_t n = 1; n <= 7; ++n) {
        for (int percent = 0; percent < 60; ++percent) { // all changes are parallel
            const double rate = 0.01 * percent;
            const int count = iterations(std::vector<double>(n, rate), true);
            BOOST_TEST(count < 12, n << " numbers, rate " << rate << ": " << count);
        }
    }
}
