// The arithmetic that the bounds count with: any other is noticed, by the thread that computes.
// Sizes of long vectors.
#include "contact/candidates.hpp"
#include "core/dot.hpp"
#include "io/vertex_text.hpp"
#include "rigidity/isostatic.hpp"
#include "support/crafted.hpp"
#include "support/threads.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/checker/verify.hpp>
#include <isostat/crafted/exact_packing.hpp>
#include <isostat/crafted/plateau.hpp>
#include <isostat/foreign/foreign.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/preparation/preparation.hpp>
#include <isostat/rigidity/counting.hpp>
#include <isostat/scene/scene.hpp>

#include <cfenv>
#include <thread>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

using namespace isostat;

namespace {

/// Another direction of rounding for one scope.
struct Rounding {
    explicit Rounding(int direction) { std::fesetround(direction); }
    Rounding(const Rounding&) = delete;
    Rounding& operator=(const Rounding&) = delete;
    ~Rounding() { std::fesetround(FE_TONEAREST); }
};

/// The exit status that `work` leads to when results are rounded up; 0 when it does not notice.
int status_rounding_up(const std::function<void()>& work) {
    try {
        const Rounding up(FE_UPWARD);
        work();
    } catch (const Error& error) {
        return error.exit_status();
    }
    return 0;
}

} // namespace

BOOST_AUTO_TEST_CASE(arithmetic_as_it_must_be_has_no_defect) {
    BOOST_TEST((floating_point_defect() == nullptr));
    BOOST_CHECK_NO_THROW(require_floating_point());
}

BOOST_AUTO_TEST_CASE(directed_rounding_is_a_defect) {
    for (const int direction : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
        const char* defect = nullptr;
        {
            const Rounding rounding(direction);
            defect = floating_point_defect();
        }
        BOOST_TEST_REQUIRE((defect != nullptr), direction);
        BOOST_TEST(std::string(defect).find("nearest") != std::string::npos);
    }
}

#if defined(__SSE2__)
BOOST_AUTO_TEST_CASE(a_change_of_the_vector_unit_alone_is_a_defect) {
    const unsigned sound = _mm_getcsr();
    // Flush to zero, denormals are zero, and the three directions of rounding.
    for (const unsigned change : {0x8000U, 0x0040U, 0x2000U, 0x4000U, 0x6000U}) {
        _mm_setcsr(sound | change);
        const char* const defect = floating_point_defect();
        _mm_setcsr(sound);
        BOOST_TEST((defect != nullptr), change);
    }
}
#endif

BOOST_AUTO_TEST_CASE(every_way_into_the_library_refuses_other_arithmetic) {
    const State state = ::crafted::two_disks(1, 2, 1, 1);
    const std::string text = state_text(state);
    Certificate certificate;
    certificate.state = state;
    RunCounters counters;
    struct Nothing final : RunObserver {
        void on_arc(const ArcRecord& /*arc*/) override {}
        void on_equilibrium(const EquilibriumRecord& /*record*/, const State& /*state*/,
                            const std::vector<double>& /*forces*/) override {}
    } nothing;
    const std::vector<std::pair<const char*, std::function<void()>>> ways{
        {"inspect_vertex", [&] { (void)inspect_vertex(state); }},
        {"certify", [&] { (void)certify(state); }},
        {"verify", [&] { (void)verify(certificate); }},
        {"count_contacts", [&] { (void)count_contacts(state.packing, state.contacts); }},
        {"certify_admissible", [&] { (void)certify_admissible(state.packing, 0); }},
        {"prove", [&] { (void)IsostaticStructure::prove(state.packing, state.contacts); }},
        {"run_segment",
         [&] {
             State moved = state;
             (void)run_segment(moved, Segment{}, 0, {}, counters, nothing);
         }},
        {"prepare",
         [&] {
             PreparationReport report;
             (void)prepare({}, report);
         }},
        {"plateau", [&] { (void)isostat::crafted::plateau(state.packing, {0.1}); }},
        {"crafted::inspect", [&] { (void)isostat::crafted::inspect(isostat::crafted::exact_copy(state.packing)); }},
        {"parse_state", [&] { (void)parse_state(text, "text"); }},
        {"parse_vertex_text", [&] { (void)parse_vertex_text("1\n", "text"); }},
        {"parse_scene", [&] { (void)parse_scene("[packing]\ndisks = 4\n", "text", ""); }},
        {"parse_foreign", [&] { (void)parse_foreign("x y r\n0 0 1\n", "text", {}); }},
    };
    for (const auto& [name, work] : ways) {
        BOOST_TEST(status_rounding_up(work) == 70, name);
    }
}

BOOST_AUTO_TEST_CASE(a_thread_that_inherited_other_arithmetic_does_no_work) {
    const Threads threads(2);
    const auto task = [] {
        Task work([] {}); // the worker begins with it and inherits
        std::fesetround(FE_TONEAREST);
        while (work.underway()) {
            std::this_thread::yield();
        }
        work.finish();
    };
    BOOST_TEST(status_rounding_up(task) == 70);
}

BOOST_AUTO_TEST_CASE(the_largest_component_is_no_number_where_one_is_none) {
    // It was left out: what divided by 0 passed for a step of length 0.
    constexpr double infinity = std::numeric_limits<double>::infinity();
    BOOST_TEST(isostat::largest(std::vector<double>()) == 0);
    for (const std::size_t size : {1U, 7U, 8U, 9U, 40U}) {
        for (std::size_t at = 0; at < size; ++at) {
            std::vector<double> x(size, 0.5);
            x[at] = -2;
            BOOST_TEST(isostat::largest(x) == 2);
            x[at] = -infinity;
            BOOST_TEST(isostat::largest(x) == infinity);
            x[at] = std::nan("");
            BOOST_TEST(std::isnan(isostat::largest(x)));
            x[size - 1] = infinity;
            BOOST_TEST((std::isnan(isostat::largest(x)) || at == size - 1));
        }
    }
}
