// No field of a certificate can be altered so that it claims more than is true and still verifies.
#include "checker/claims.hpp"
#include "checker/maker.hpp"
#include "checker/small_states.hpp"
#include "oracle/claims.hpp"
#include "oracle/pairs.hpp"
#include "support/cells.hpp"
#include "support/forger.hpp"
#include "support/scale.hpp"
#include "support/scratch.hpp"
#include "support/spheres.hpp"

using namespace isostat;

namespace {

constexpr double huge = std::numeric_limits<double>::infinity();

/// One alteration, and the claims of which at least one must not be proved any more; the first of them is refuted when
/// `refuted`.
struct ClaimAlteration {
    std::string name;
    std::function<void(Certificate&)> apply;
    bool refuted = true;
};

struct ClaimAlterations : std::vector<ClaimAlteration> {
    void add(const std::string& name, std::function<void(Certificate&)> apply) { add(name, true, std::move(apply)); }
    void add(const std::string& name, bool refuted, std::function<void(Certificate&)> apply) {
        push_back({name, std::move(apply), refuted});
    }
};

std::string digest_in(const std::string& text) {
    return text.substr(text.find("\"digest\": \"") + 11, 64);
}

/// The alteration in a file whose digest was kept: bad input. With a digest of its own: read, and not verified.
void does_not_verify(const Certificate& original, const ClaimAlteration& alteration) {
    BOOST_TEST_INFO_SCOPE(alteration.name);
    Certificate altered = original;
    alteration.apply(altered);
    const std::string text = certificate_text(altered);
    BOOST_REQUIRE(text != certificate_text(original));
    const std::string kept = scratch::replaced(text, digest_in(text), digest_in(certificate_text(original)));
    BOOST_CHECK_THROW((void)parse_certificate(kept, "kept"), Error);

    const Verification verification = verify(altered);
    BOOST_TEST((verification.verdict != Verdict::proved));
    if (alteration.refuted) {
        BOOST_TEST((verification.verdict == Verdict::refuted));
    }
}

/// What loads are measured in.
double unit_of(const Certificate& certificate) {
    return std::abs(certificate.state.load.stress[0]);
}

ClaimAlterations alterations_of_claims(const Certificate& original) {
    ClaimAlterations list;
    using Count = int CountingClaim::*;
    const std::vector<Count> counts{&CountingClaim::dof_count, &CountingClaim::contact_count, &CountingClaim::rank,
                                    &CountingClaim::hyperstaticity, &CountingClaim::hypostaticity};
    for (std::size_t k = 0; k < counts.size(); ++k) {
        for (const int change : {1, -1}) {
            list.add("count " + std::to_string(k), [=](Certificate& c) { (*c.claims.counting).*counts[k] += change; });
        }
    }
    list.add("rank, h and k together", [](Certificate& c) {
        --c.claims.counting->rank;
        ++c.claims.counting->hyperstaticity;
        ++c.claims.counting->hypostaticity;
    });
    list.add("N_f and k together", [](Certificate& c) {
        ++c.claims.counting->dof_count;
        ++c.claims.counting->hypostaticity;
    });
    list.add("radius", [](Certificate& c) { c.claims.vertex->radius = 0; });
    list.add("unique radius", false, [](Certificate& c) { c.claims.vertex->unique_radius = 1e3; });
    list.add("unique radius without end", false, [](Certificate& c) { c.claims.vertex->unique_radius = huge; });

    const ForcesClaim& forces = *original.claims.forces;
    for (std::size_t l = 0; l < forces.finite.size(); ++l) {
        const double width = std::max(forces.finite[l].upper - forces.finite[l].lower, 1e-12);
        const std::string which = "force " + std::to_string(l);
        list.add(which + " above", [=](Certificate& c) {
            c.claims.forces->finite[l].upper += 2 * width, c.claims.forces->finite[l].lower += 2 * width;
        });
        list.add(which + " below", [=](Certificate& c) {
            c.claims.forces->finite[l].lower -= 2 * width, c.claims.forces->finite[l].upper -= 2 * width;
        });
        const bool zero = std::ranges::binary_search(forces.structural_zeros, static_cast<int>(l));
        if (!zero) {
            list.add(which + " as a structural zero", [=](Certificate& c) {
                auto& zeros = c.claims.forces->structural_zeros;
                const auto at = std::ranges::lower_bound(zeros, static_cast<int>(l));
                c.claims.forces->infinitesimal.insert(c.claims.forces->infinitesimal.begin() + (at - zeros.begin()),
                                                      Interval{-huge, huge});
                zeros.insert(at, static_cast<int>(l));
            });
            const ClaimAlteration as_zero = list.back();
            list.add(which + " as a structural zero, in any interval", [=](Certificate& c) {
                as_zero.apply(c);
                c.claims.forces->finite[l] = {-huge, huge};
            });
        }
    }
    for (std::size_t k = 0; k < forces.structural_zeros.size(); ++k) {
        const std::string which = "structural zero " + std::to_string(k);
        list.add(which + " left out", [=](Certificate& c) {
            auto& claim = *c.claims.forces;
            claim.structural_zeros.erase(claim.structural_zeros.begin() + static_cast<std::ptrdiff_t>(k));
            claim.infinitesimal.erase(claim.infinitesimal.begin() + static_cast<std::ptrdiff_t>(k));
        });
        const double width = std::max(forces.infinitesimal[k].upper - forces.infinitesimal[k].lower, 1e-12);
        for (const double change : {2 * width, -2 * width}) {
            list.add(which + " moved", [=](Certificate& c) {
                c.claims.forces->infinitesimal[k].lower += change;
                c.claims.forces->infinitesimal[k].upper += change;
            });
        }
    }

    list.add("smallest gap", [](Certificate& c) { c.claims.gaps->smallest *= 1 + 1e-6; });
    list.add("smallest gap without end", [](Certificate& c) { c.claims.gaps->smallest = huge; });
    for (const Contact& pair : oracle::all_pairs(original.state.packing)) {
        if (pair != original.claims.gaps->where && original.state.packing.disk_count() < 10) {
            list.add("nearest pair " + to_string(pair), [=](Certificate& c) { c.claims.gaps->where = pair; });
        }
    }

    using End = LoadEndClaim LoadIntervalClaim::*;
    for (const End end : {&LoadIntervalClaim::low, &LoadIntervalClaim::high}) {
        const std::string which = end == &LoadIntervalClaim::low ? "low end" : "high end";
        if (((*original.claims.load_interval).*end).unbounded) {
            list.add(which + " bounded", [=](Certificate& c) {
                (*c.claims.load_interval).*end = {false, {-huge, huge}, c.state.contacts[0]};
            });
            continue;
        }
        list.add(which + " unbounded", [=](Certificate& c) { ((*c.claims.load_interval).*end).unbounded = true; });
        for (const double change : {1e-6 * unit_of(original), -1e-6 * unit_of(original)}) {
            list.add(which + " moved", [=](Certificate& c) {
                Interval& stress = ((*c.claims.load_interval).*end).stress;
                stress = {stress.lower + change, stress.upper + change};
            });
        }
        const Contact& opens = ((*original.claims.load_interval).*end).opens;
        for (const Contact& contact : original.state.contacts) {
            const bool beside = contact.i == opens.i || contact.i == opens.j || contact.j == opens.i ||
                                (contact.j == opens.j && contact.of_disks()); // its force may vanish as well
            if (contact != opens && !(beside && original.state.packing.disk_count() > 10)) {
                // Whatever the stress is said to be: another contact does not open there.
                list.add(which + " opens " + to_string(contact), false, [=](Certificate& c) {
                    ((*c.claims.load_interval).*end).opens = contact;
                    ((*c.claims.load_interval).*end).stress = {-huge, huge};
                });
            }
        }
    }
    return list;
}

ClaimAlterations alterations_of_the_state(const Certificate& original) {
    ClaimAlterations list;
    constexpr double little = 1e-8;
    const Packing& packing = original.state.packing;
    const Load& load = original.state.load;
    const std::size_t disks = packing.radius.size(), axes = packing.axes();
    const bool zeros = !original.claims.forces->structural_zeros.empty();
    const bool box = !packing.cell.any();
    const double unit = unit_of(original);
    const auto rests = [&](std::size_t disk) { return !box && static_cast<int>(disk) == packing.cell.pin; };
    for (const double change : {little, -little}) {
        for (std::size_t i = 0; i < disks; ++i) {
            list.add("radius of " + std::to_string(i), [=](Certificate& c) { c.state.packing.radius[i] += change; });
        }
        for (std::size_t k = 0; k < packing.q.size(); ++k) {
            if (k < packing.length_at(axes) || packing.cell.all()) { // a channel has no tilt
                list.add((k < packing.length_at(0) ? "coordinate " : "entry of the cell ") + std::to_string(k),
                         [=](Certificate& c) { c.state.packing.q[k] += change; });
            }
        }
        for (std::size_t a = 0; a < axes; ++a) {
            list.add("stress", [=](Certificate& c) { c.state.load.stress[a] += change * unit; });
            list.add("reference length", [=](Certificate& c) { c.state.load.reference_length[a] += change; });
        }
        const ForcesClaim& forces = *original.claims.forces;
        for (std::size_t k = 0; k < forces.structural_zeros.size(); ++k) {
            const Interval& force = forces.infinitesimal[k];
            const double push = std::copysign(10 * little + 100 * (force.upper - force.lower), change);
            const Contact& contact = original.state.contacts[static_cast<std::size_t>(forces.structural_zeros[k])];
            const auto one = static_cast<std::size_t>(contact.i);
            const auto other = contact.of_disks() ? static_cast<std::size_t>(contact.j) : one;
            if (rests(one) || rests(other)) {
                continue;
            }
            list.add("infinitesimal load of " + std::to_string(one), box, [=](Certificate& c) {
                for (std::size_t a = 0; a < axes; ++a) {
                    c.state.load.infinitesimal[axes * one + a] += push;
                    c.state.load.infinitesimal[axes * other + a] += push; // which of them rattles
                }
            });
        }
    }
    if (zeros) {
        list.add("no infinitesimal load", [](Certificate& c) { c.state.load.infinitesimal.clear(); });
    }
    list.add("loaded axis", [](Certificate& c) { c.state.load.loaded_axis = 0; });
    if (load.reference_length[0] != packing.length(0)) { // otherwise it is the same load
        list.add("kind of load", box, [](Certificate& c) { c.state.load.kind = LoadKind::true_stress; });
    }
    for (std::size_t k = 0; k < axes * disks; ++k) {
        if (rests(k / axes)) {
            continue;
        }
        list.add("force on a disk", box, [=](Certificate& c) {
            c.state.load.disk_force.assign(axes * disks, 0.0);
            c.state.load.disk_force[k] = little;
        });
    }
    for (std::size_t a = 0; a < axes; ++a) {
        if (packing.cell.periodic[a]) {
            continue;
        }
        for (const WallKind kind : {WallKind::fixed, WallKind::absent}) {
            list.add("upper wall", kind == WallKind::fixed,
                     [=](Certificate& c) { c.state.packing.walls.upper[a] = kind; });
        }
    }
    for (std::size_t i = 0; i < disks; ++i) {
        if (rests(i)) {
            continue;
        }
        list.add("fixed disk", box, [=](Certificate& c) {
            c.state.packing.fixed.assign(disks, 0);
            c.state.packing.fixed[i] = 1;
        });
    }
    const std::size_t contacts = original.state.contacts.size();
    for (std::size_t l = 0; l < contacts; ++l) {
        list.add("contact left out", [=](Certificate& c) {
            c.state.contacts.erase(c.state.contacts.begin() + static_cast<std::ptrdiff_t>(l));
            c.claims.forces->finite.pop_back();
            c.claims.forces->structural_zeros.clear();
            c.claims.forces->infinitesimal.clear();
            c.claims.load_interval = {};
        });
        list.add("contact exchanged", false, [=](Certificate& c) { c.state.contacts[l] = c.claims.gaps->where; });
    }
    list.add("order of contacts", [](Certificate& c) { std::swap(c.state.contacts[1], c.state.contacts[3]); });
    return list;
}

/// Of the images of contacts, and of what moves in a cell.
ClaimAlterations alterations_of_the_cell(const Certificate& original) {
    ClaimAlterations list;
    const auto add = [&list](const std::string& name, std::function<void(Certificate&)> apply) {
        list.add(name, false, std::move(apply));
    };
    const Packing& packing = original.state.packing;
    const auto first_image = [](Certificate& c) -> Image& {
        return std::ranges::find_if(c.state.contacts, [](const Contact& l) { return l.i != l.j && !l.image.is_here(); })
            ->image;
    };
    add("image changed", [](Certificate& c) {
        std::int8_t& across = std::ranges::find_if(c.state.contacts, [](const Contact& l) {
                                  return l.kind == ContactKind::disk_disk;
                              })->image.m[1];
        across = across == 1 ? 0 : 1;
    });
    if (!packing.cell.any()) {
        return list;
    }
    add("image left out", [=](Certificate& c) { first_image(c) = {}; });
    add("image turned round", [=](Certificate& c) { first_image(c) = first_image(c).opposite(); });
    add("gap of another image", [](Certificate& c) { c.claims.gaps->where.image.m[0] += 1; });
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        if (packing.cell.period_moves[a]) {
            add("period at rest", [=](Certificate& c) { c.state.packing.cell.period_moves[a] = false; });
            add("walls in the place of a period", [=](Certificate& c) {
                c.state.packing.cell.periodic[a] = c.state.packing.cell.period_moves[a] = false;
                c.state.packing.walls.upper[a] = WallKind::movable;
            });
        }
    }
    add("tilt that moves or not",
        [](Certificate& c) { c.state.packing.cell.tilt_moves[0] = !c.state.packing.cell.tilt_moves[0]; });
    if (packing.cell.tilt_moves[0]) {
        add("shear", [](Certificate& c) { c.state.load.shear[0] += 1e-8 * unit_of(c); });
    }
    add("loads that do not sum to zero", [](Certificate& c) { c.state.load.infinitesimal.at(0) += 1; });
    return list;
}

ClaimAlterations all_alterations(const Certificate& original) {
    ClaimAlterations all = alterations_of_claims(original);
    for (const auto& more : {alterations_of_the_state(original), alterations_of_the_cell(original)}) {
        all.insert(all.end(), more.begin(), more.end());
    }
    return all;
}

/// The first and the last alteration of each kind: of those whose names differ in numbers only.
std::vector<ClaimAlteration> of_each_kind(const std::vector<ClaimAlteration>& all) {
    std::map<std::string, std::pair<const ClaimAlteration*, const ClaimAlteration*>> kinds;
    for (const ClaimAlteration& one : all) {
        std::string kind = one.name;
        std::erase_if(kind, [](char letter) { return letter >= '0' && letter <= '9'; });
        kinds.try_emplace(kind, &one, &one).first->second.second = &one;
    }
    std::vector<ClaimAlteration> sample;
    for (const auto& [kind, ends] : kinds) {
        sample.push_back(*ends.first);
        if (ends.second != ends.first) {
            sample.push_back(*ends.second);
        }
    }
    return sample;
}

} // namespace

BOOST_AUTO_TEST_CASE(no_altered_claim_of_a_small_packing_verifies) {
    const Certificate original = maker::certificate(small_states::with_a_rattler());
    BOOST_REQUIRE((verify(original).verdict == Verdict::proved));
    for (const ClaimAlteration& alteration : all_alterations(original)) {
        does_not_verify(original, alteration);
    }
}

BOOST_AUTO_TEST_CASE(no_altered_certificate_of_a_larger_packing_verifies, *boost::unit_test::label("slow")) {
    std::vector<std::pair<std::string, Certificate>> originals{
        {"a hundred disks", maker::certificate(read_state(scratch::data("vertex100.txt")).state)}};
    for (const char* name : {"rect", "tilt", "channel"}) {
        State state = cells::of_file(name + std::string("_16"));
        state.load.reference_length[0] *= 1 + 0x1p-20; // so that the kind of load matters
        originals.emplace_back(name, claims::certified(state));
    }
    for (const char* name : {"box_bidisperse_30_1", "tri_uniform_30_1"}) {
        originals.emplace_back(name, claims::certified(test::state_of_spheres(test::read_spheres(name))));
    }
    for (const auto& [name, original] : originals) {
        BOOST_TEST_INFO_SCOPE(name);
        BOOST_REQUIRE((verify(original).verdict == Verdict::proved));
        for (const ClaimAlteration& alteration : of_each_kind(all_alterations(original))) {
            does_not_verify(original, alteration);
        }
    }
}

// What is weaker than the original and true may verify, and does.
BOOST_AUTO_TEST_CASE(weaker_claims_verify) {
    Certificate weaker = maker::certificate(small_states::with_a_rattler());
    weaker.claims.vertex->radius *= 3;
    weaker.claims.vertex->unique_radius /= 3;
    for (Interval& force : weaker.claims.forces->finite) {
        force = {-huge, force.upper + 1};
    }
    weaker.claims.gaps->smallest /= 2;
    weaker.claims.load_interval->high.stress.upper += 1;
    BOOST_TEST((verify(weaker).verdict == Verdict::proved));
}

// Bytes are spoilt at random and the digest is made to fit, as a forger would. Whatever is read and proved must be
// true.
BOOST_AUTO_TEST_CASE(random_forgeries_prove_nothing_that_is_wrong, *boost::unit_test::label("slow")) {
    const std::string text = certificate_text(maker::certificate(small_states::with_a_rattler()));
    std::mt19937_64 random(7);
    const auto below = [&random](std::size_t limit) { return static_cast<std::size_t>(random() % limit); };
    const std::string digits = "0123456789.-e";
    int read = 0, proved = 0;
    for (int trial = 0; trial < testing::scaled(1500); ++trial) {
        std::string spoilt = text;
        for (std::size_t k = 1 + below(2); k > 0; --k) {
            std::size_t at = below(spoilt.size());
            while (digits.find(spoilt[at]) == std::string::npos) {
                at = below(spoilt.size());
            }
            if (below(4) == 0) {
                spoilt.insert(at, 1, digits[below(digits.size())]);
            } else {
                spoilt[at] = digits[below(digits.size())];
            }
        }
        Certificate forged;
        try {
            forged = parse_certificate(forger::sealed_certificate(spoilt), "forged");
        } catch (const Error&) {
            continue;
        }
        ++read;
        if (verify(forged).verdict == Verdict::proved) {
            ++proved;
            const oracle::Truth truth(forged.state);
            BOOST_TEST_REQUIRE(truth.known, truth.why);
            const auto& counting = *forged.claims.counting;
            for (const int count : {counting.dof_count, counting.contact_count, counting.rank}) {
                BOOST_TEST(count == truth.dof_count(), spoilt);
            }
            BOOST_TEST(oracle::objections(forged.claims, forged.state, truth) == std::vector<std::string>{},
                       boost::test_tools::per_element());
        }
    }
    BOOST_TEST(read > 200);
    BOOST_TEST(proved > 5);
    BOOST_TEST(proved < read);
    BOOST_TEST_MESSAGE(read << " read, " << proved << " proved");
}
