// Perturbed radii: crystals become isostatic, isostatic packings keep their contacts.

#include "crafted/genericity.hpp"
#include "examples.hpp"

namespace {

using namespace isostat::crafted;
using examples::example;

Genericity perturbed(const ExactPacking& exact, int samples, double size, bool tilt = false) {
    return genericity(approximate(exact), required(exact_contacts(exact)),
                      {.samples = samples, .size = size, .tilt = tilt});
}

Genericity perturbed(const std::string& name, int samples, double size) {
    return perturbed(example(name), samples, size);
}

/// Force-carrying contacts of every proved sample: as many as degrees of freedom without the rattlers.
bool all_isostatic(const Genericity& answer, const ExactPacking& exact) {
    const int dofs = isostat::DofMap(approximate(exact)).dof_count();
    return std::ranges::all_of(answer.samples, [&](const GenericitySample& sample) {
        return !sample.failure && static_cast<int>(sample.carrying.size()) == dofs - 2 * sample.rattlers;
    });
}

} // namespace

BOOST_AUTO_TEST_CASE(an_isostatic_packing_keeps_its_contacts) {
    const Genericity answer = perturbed("two_disks.toml", 20, 1e-4);
    BOOST_TEST(answer.proved == 20);
    BOOST_REQUIRE_EQUAL(answer.lists.size(), 1u);
    BOOST_TEST((answer.lists[0].contacts == exact_contacts(example("two_disks.toml")).value()));
    for (const GenericitySample& sample : answer.samples) {
        BOOST_TEST(sample.within_original);
        BOOST_TEST(sample.carrying.size() == 6U);
        BOOST_TEST(sample.rattlers == 0);
        BOOST_TEST(sample.min_force > 0);
        BOOST_TEST(sample.sigma_min > 0);
    }
}

BOOST_AUTO_TEST_CASE(a_perturbed_lattice_is_isostatic_on_some_of_its_contacts) {
    for (const char* name : {"square_lattice_3.toml", "triangular_patch_3x3.toml"}) {
        const Genericity answer = perturbed(name, 20, 1e-4);
        BOOST_TEST_INFO_SCOPE(name);
        int within = 0;
        for (const GenericitySample& sample : answer.samples) {
            BOOST_TEST_MESSAGE(name << " seed " << sample.seed << ": "
                                    << (sample.failure ? sample.failure->message()
                                                       : std::to_string(sample.carrying.size()) + " carrying"));
            if (!sample.failure) {
                BOOST_TEST(sample.contacts.size() == 20u);
                BOOST_TEST(static_cast<int>(sample.carrying.size()) == 2 * (9 - sample.rattlers) + 2);
                within += sample.within_original ? 1 : 0;
            }
        }
        BOOST_TEST_MESSAGE(name << ": proved " << answer.proved << ", lists " << answer.lists.size()
                                << ", within the lattice " << within);
        BOOST_TEST(answer.proved >= 15);
        BOOST_TEST(answer.lists.size() > 1u);
    }
}

BOOST_AUTO_TEST_CASE(perturbations_far_below_the_tolerances_of_a_linear_solver_are_told_apart) {
    for (const char* name : {"square_lattice_3.toml", "triangular_patch_3x3.toml"}) {
        for (const double size : {1e-7, 1e-10, 1e-12}) {
            const Genericity answer = perturbed(name, 20, size);
            BOOST_TEST_INFO_SCOPE(name << " " << size);
            BOOST_TEST(answer.proved >= 19);
            int far = 0;
            for (const GenericitySample& sample : answer.samples) {
                if (!sample.failure) {
                    // Both margins scale with the perturbation.
                    BOOST_TEST(sample.min_gap > 0);
                    BOOST_TEST(sample.min_gap < 10 * size);
                    BOOST_TEST(sample.min_force > 0);
                    BOOST_TEST(sample.within_original);
                    far += sample.rung == isostat::Rung::multiprecision ? 1 : 0;
                }
            }
            // Forces of the square lattice shrink like a power of the size: some need more than double-double.
            if (name == std::string("square_lattice_3.toml") && size < 1e-9) {
                BOOST_TEST(far > 0);
            }
        }
    }
}

BOOST_AUTO_TEST_CASE(equal_radii_that_stay_equal_are_never_called_isostatic) {
    // Square lattice: a scaled copy, h = 4. Two sizes: two self-stresses are left for every ratio of the radii.
    for (const char* name : {"square_lattice_3.toml", "interstitial_lattice.toml"}) {
        const ExactPacking exact = example(name);
        GenericityOptions options{.samples = 10, .size = 1e-3, .keep_equal = true};
        const auto contacts = exact_contacts(exact).value();
        const Genericity equal = genericity(approximate(exact), contacts, options);
        options.keep_equal = false;
        const Genericity free = genericity(approximate(exact), contacts, options);
        BOOST_TEST_INFO_SCOPE(name);
        BOOST_TEST(equal.proved == 0);
        BOOST_TEST(equal.ties == 10);
        BOOST_TEST(free.proved == 10);
    }
}

// T7p: with a tilt that moves, and in channels, generic radii are enough.
BOOST_AUTO_TEST_CASE(lattices_in_channels_and_cells_with_a_tilt_become_isostatic) {
    for (const char* name :
         {"cell_triangular_lattice_6.toml", "cell_square_lattice_2.toml", "channel_square_lattice_3.toml",
          "cell_two_disks_tilted.toml", "cell_one_disk_tilted.toml", "channel_two_disks_low.toml"}) {
        ExactPacking exact = example(name);
        exact.cell.tilt_moves = {exact.cell.all()};
        for (const double size : {1e-2, 1e-5}) {
            BOOST_TEST(all_isostatic(perturbed(exact, 5, size), exact), name);
        }
    }
}

// T7 is false in rectangles: two disks tie for all radii. The tilt is what is not generic.
BOOST_AUTO_TEST_CASE(two_disks_of_a_rectangle_tie_for_all_radii_and_no_longer_with_another_tilt) {
    ExactPacking exact = example("counterexample_t7_centred_rectangle.toml");
    for (const double size : {1e-2, 1e-5}) {
        const Genericity radii = perturbed(exact, 5, size);
        BOOST_TEST(radii.proved == 0);
        BOOST_TEST(radii.ties == 5);
        const Genericity both = perturbed(exact, 5, size, true);
        BOOST_TEST(all_isostatic(both, exact));
    }
    exact.cell.tilt_moves = {true};
    BOOST_TEST(all_isostatic(perturbed(exact, 5, 1e-2), exact));
}

// Shape kept: the triangular lattice bears every strain of its shape with several self-stresses, and generic radii
// leave the one that a pressure needs; so they do on another lattice.
BOOST_AUTO_TEST_CASE(lattices_in_cells_that_keep_their_shape_have_one_self_stress_left) {
    ExactPacking exact = example("cell_triangular_lattice_6.toml");
    exact.load.reset();
    exact.cell.period_moves = {false, false};
    for (const bool tilt : {false, true}) {
        const Genericity result = perturbed(exact, 5, 1e-3, tilt);
        BOOST_TEST(result.proved == 5);
        for (const auto& sample : result.samples) {
            BOOST_TEST(sample.contacts.size() == 2 * exact.radius.size() - 1);
        }
    }
}

BOOST_AUTO_TEST_CASE(the_same_seed_gives_the_same_samples) {
    const Genericity a = perturbed("triangular_patch_2x3.toml", 5, 1e-3),
                     b = perturbed("triangular_patch_2x3.toml", 5, 1e-3);
    for (std::size_t s = 0; s < a.samples.size(); ++s) {
        BOOST_TEST((a.samples[s].contacts == b.samples[s].contacts));
        BOOST_TEST(a.samples[s].min_gap == b.samples[s].min_gap);
        BOOST_TEST(a.samples[s].min_force == b.samples[s].min_force);
    }
}

BOOST_AUTO_TEST_CASE(a_packing_or_an_option_that_does_not_fit_is_refused) {
    const auto box = approximate(example("two_disks.toml"));
    BOOST_CHECK_THROW((void)genericity(approximate(example("arch.toml")), {}, {}), isostat::Error);
    for (const double size : {-1.0, 0.5, 1e300}) {
        BOOST_CHECK_THROW((void)genericity(box, {}, {.size = size}), isostat::Error);
    }
    GenericityOptions tilt{.tilt = true};
    BOOST_CHECK_THROW((void)genericity(box, {}, tilt), isostat::Error);
    BOOST_CHECK_THROW((void)genericity(approximate(example("channel_one_disk.toml")), {}, tilt), isostat::Error);
    auto half = approximate(example("cell_hexagonal_row.toml"));
    half.cell.period_moves = {true, false};
    BOOST_CHECK_THROW((void)genericity(half, {}, {}), isostat::Error);
    BOOST_CHECK_THROW((void)genericity(box, {}, {.samples = 0}), isostat::Error);
}
