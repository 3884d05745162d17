#include "crafted/genericity.hpp"

#include "core/parallel.hpp"
#include "core/refuse.hpp"
#include "packing/arc_bodies.hpp"
#include "packing/bodies.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/core/machine.hpp>
#include <isostat/preparation/preparation.hpp>
#include <isostat/rigidity/counting.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <string>

namespace isostat::crafted {

namespace {

/// Largest shortening of a lattice vector of length 1 by tilts that move by L_a: the norm of D A^-1.
double shear(const Packing& packing) {
    double square = 0;
    for (std::size_t b = 1; b < packing.axes(); ++b) {
        for (std::size_t a = 0; a < b; ++a) {
            const bool over = b == 2 && a == 0; // through the period of y
            const double lean = over ? std::abs(packing.lattice(1, 2)) / packing.lattice(1, 1) : 0;
            const double entry = packing.lattice(a, a) / packing.lattice(b, b) * (1 + lean);
            square += entry * entry;
        }
    }
    return std::sqrt(square);
}

void check(const Packing& packing, const GenericityOptions& options) {
    bool gives_way = std::ranges::count(packing.fixed, 1) == 0;
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        const bool box = packing.walls.lower[a] == WallKind::fixed && packing.walls.upper[a] == WallKind::movable;
        gives_way =
            gives_way && (packing.cell.periodic[a] ? packing.cell.period_moves[a] || packing.cell.keeps_shape : box);
    }
    if (!gives_way) {
        refuse("genericity", "expected along each axis a fixed lower and a movable upper wall, or a period that moves, "
                             "and no fixed disk");
    }
    if (options.tilt && !packing.cell.all()) {
        refuse("genericity", "the tilt is to be perturbed: expected a period along each axis");
    }
    const auto require = [](bool holds, const char* field, const std::string& found, const char* wanted) {
        if (!holds) {
            throw Error(ErrorKind::bad_input,
                        std::string("genericity: ") + field + " = " + found + ", expected " + wanted);
        }
    };
    require(options.samples >= 1, "samples", std::to_string(options.samples), "at least 1");
    require(options.size >= 0 && options.size < 0.5, "size", std::to_string(options.size),
            "a number from 0 to below 0.5");
    if (options.tilt) {
        const double sheared = options.size * shear(packing);
        require(sheared < 0.5,
                packing.dimension == plane ? "shear of the cell, size times L_x / L_y,"
                                           : "size times the shear of the cell",
                std::to_string(sheared), "a number below 0.5");
    }
    require(options.stress > 0 && std::isfinite(options.stress), "stress", std::to_string(options.stress),
            "a positive number");
}

/// Perturbs the radii, the places of members unless equal radii stay equal, and the tilt if that is requested.
void perturb(Packing& packing, const GenericityOptions& options, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto change = [&] { return options.size * (static_cast<double>(random() >> 11) * 0x1p-52 - 1); };
    std::map<double, double> factor_of; // one factor for each class of equal radii
    for (double& r : packing.radius) {
        const auto known = factor_of.find(r);
        double factor = known == factor_of.end() ? 0 : known->second;
        if (known == factor_of.end() || !options.keep_equal) {
            factor = 1 + change();
            factor_of[r] = factor;
        }
        r *= factor;
    }
    const std::vector<std::vector<int>> bodies =
        Bodies(packing).members(options.keep_equal ? packing.radius.size() + 1 : 2);
    for (const std::vector<int>& body : bodies) {
        for (const int member : body) {
            const auto i = static_cast<std::size_t>(member);
            double* const x = &packing.q[packing.axes() * i];
            std::for_each(x, x + packing.axes(), [&](double& moved) { moved += change() * packing.radius[i]; });
        }
    }
    if (!bodies.empty()) {
        packing.bars = bars_of_bodies(packing, bodies, "genericity");
    }
    if (options.tilt) {
        for (std::size_t b = 1; b < packing.axes(); ++b) {
            for (std::size_t a = 0; a < b; ++a) {
                packing.q[packing.tilt_at(a, b)] += change() * packing.lattice(a, a);
            }
        }
    }
    if (packing.cell.any()) {
        // All grains move apart, so that no disk overlaps its own image.
        const double shorter = options.tilt ? options.size * shear(packing) : 0;
        for (double& x : packing.q) {
            x *= (1 + options.size) / (1 - shorter);
        }
    }
}

/// Counts the bodies of which no member bears a force, and the turns of those of which one does (in space, or two do).
void count_bodies(GenericitySample& sample, const Packing& packing) {
    const std::vector<int> idle = untouched(packing.disk_count(), sample.carrying);
    for (const std::vector<int>& body : Bodies(packing).members(1)) {
        const auto all = static_cast<int>(body.size());
        const auto bear = static_cast<int>(
            std::ranges::count_if(body, [&](int member) { return !std::ranges::binary_search(idle, member); }));
        sample.rattlers += bear == 0 ? 1 : 0;
        sample.turns += bear == 0 ? 0 : body_freedoms(all, packing.dimension) - body_freedoms(bear, packing.dimension);
    }
}

/// Fills in the claims of the certificate, or the reason when a claim of an isostatic equilibrium is missing.
void fill(GenericitySample& sample, const State& state, const Certification& certified) {
    const CertificateClaims& claims = certified.claims;
    if (!claims.counting || !claims.vertex || !claims.forces || !claims.gaps || !claims.stable ||
        claims.counting->hyperstaticity != 0 ||
        (claims.counting->hypostaticity != 0 && state.packing.bars.empty())) { // of clumps: free motions
        std::string why = "no certificate";
        for (const std::string& reason : claims.undecided) {
            why += (why == "no certificate" ? ": " : "; ") + reason;
        }
        // find_vertex proves signs for the stored coordinates; a force at the true vertex may have the other sign.
        sample.failure =
            Failure{certified.verdict == Verdict::refuted ? FailureKind::not_converged : FailureKind::undecided, why};
        return;
    }
    sample.contacts = unilateral(state.contacts);
    sample.min_force = std::numeric_limits<double>::infinity();
    const std::vector<int>& zeros = claims.forces->structural_zeros;
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        if (std::ranges::binary_search(zeros, static_cast<int>(l)) || !state.contacts[l].is_unilateral()) {
            continue;
        }
        sample.carrying.push_back(state.contacts[l]);
        sample.min_force = std::min(sample.min_force, claims.forces->finite[l].lower);
    }
    sample.mechanisms = claims.counting->hypostaticity;
    count_bodies(sample, state.packing);
    sample.min_gap = claims.gaps->smallest;
    sample.sigma_min = certified.smallest_sigma;
    sample.rung = std::max({claims.vertex->rung, claims.forces->rung, claims.gaps->rung});
}

/// One sample, from the sorted contacts of the unperturbed packing. \p attempt: which infinitesimal loads.
GenericitySample sampled(const Packing& packing, const std::vector<Contact>& original, const GenericityOptions& options,
                         std::uint64_t seed, std::uint64_t attempt) {
    GenericitySample sample;
    sample.seed = seed;
    Packing start = packing;
    perturb(start, options, seed);
    PreparationOptions preparation;
    preparation.seed = seed + (attempt << 32U);
    preparation.stress = options.stress;
    PreparationReport report;
    const auto found = find_vertex(start, preparation, report);
    if (!found.ok() && (!report.candidate || found.failure().kind == FailureKind::tie)) {
        sample.failure = found.failure();
        return sample;
    }
    const State& state = found.ok() ? found.value() : *report.candidate;
    fill(sample, state, certify(state));
    if (!sample.failure) {
        sample.within_original = std::ranges::all_of(
            sample.carrying, [&](const Contact& contact) { return std::ranges::binary_search(original, contact); });
    }
    return sample;
}

} // namespace

int Genericity::within() const {
    return static_cast<int>(
        std::ranges::count_if(samples, [](const GenericitySample& sample) { return sample.within_original; }));
}

std::map<std::string, int> Genericity::rungs() const {
    std::map<std::string, int> out;
    for (const GenericitySample& sample : samples) {
        if (!sample.failure) {
            ++out[std::string(to_string(sample.rung))];
        }
    }
    return out;
}

Genericity genericity(const Packing& given, const std::vector<Contact>& original, const GenericityOptions& options) {
    require_floating_point();
    Packing packing = given;
    const auto moves = [](const auto& flags) { return std::ranges::find(flags, true) != flags.end(); };
    if (packing.cell.all() && !moves(packing.cell.period_moves) && !moves(packing.cell.tilt_moves)) {
        packing.cell.keep_shape(); // other radii require another size of the cell
    }
    check(packing, options);
    require_no_arcs(packing, "genericity", "a perturbed copy");
    Genericity out;
    std::vector<Contact> sorted = original;
    std::ranges::sort(sorted);
    out.samples.resize(static_cast<std::size_t>(options.samples));
    parallel_pieces(out.samples.size(), [&](std::size_t s) {
        const std::uint64_t attempts = packing.bars.empty() ? 1 : 4; // a body that hangs under some loads may rest
        for (std::uint64_t a = 0; a < attempts && (a == 0 || out.samples[s].failure); ++a) {
            out.samples[s] = sampled(packing, sorted, options, options.seed + s, a);
        }
    });
    for (const GenericitySample& sample : out.samples) {
        if (sample.failure) {
            ++(sample.failure->kind == FailureKind::tie         ? out.ties
               : sample.failure->kind == FailureKind::undecided ? out.undecided
                                                                : out.failed);
            continue;
        }
        ++out.proved;
        const auto known = std::ranges::find_if(
            out.lists, [&](const ContactListCount& list) { return list.contacts == sample.carrying; });
        if (known == out.lists.end()) {
            out.lists.push_back({sample.carrying, 1});
        } else {
            ++known->samples;
        }
    }
    std::ranges::stable_sort(
        out.lists, [](const ContactListCount& a, const ContactListCount& b) { return a.samples > b.samples; });
    return out;
}

} // namespace isostat::crafted
