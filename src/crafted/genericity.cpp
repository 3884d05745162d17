#include <isostat/core/error.hpp>
#include <isostat/crafted/genericity.hpp>
#include <isostat/preparation/preparation.hpp>
#include <isostat/rigidity/isostatic.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

namespace isostat::crafted {

namespace {

void check(const Packing<2>& packing, const GenericityOptions& options) {
    if (!(packing.walls == Walls<2>::box()) || std::count(packing.fixed.begin(), packing.fixed.end(), 1) > 0) {
        throw Error(ErrorKind::bad_input,
                    "genericity: expected two fixed lower walls, two movable upper walls and no fixed disk");
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
    require(options.stress > 0 && std::isfinite(options.stress), "stress", std::to_string(options.stress),
            "a positive number");
}

/// Contacts that carry a force of the walls' load: those not structurally zero (statement T11).
std::vector<Contact> carriers(const State<2>& state) {
    const auto structure = IsostaticStructure<2>::prove(state.packing, state.contacts);
    if (!structure.ok()) {
        return {};
    }
    const auto& matrix = structure.value().matrix();
    const int n = state.packing.disk_count();
    const std::array<int, 2> walls{2 * n, 2 * n + 1};
    const auto nonzero = sparse::structural_nonzeros(matrix.start, matrix.row, structure.value().ordering(), walls);
    std::vector<Contact> out;
    for (std::size_t l = 0; l < nonzero.size(); ++l) {
        if (nonzero[l] != 0) {
            out.push_back(structure.value().contacts()[l]);
        }
    }
    return out;
}

} // namespace

Genericity genericity(const Packing<2>& packing, const std::vector<Contact>& original,
                      const GenericityOptions& options) {
    check(packing, options);
    Genericity out;
    std::vector<Contact> sorted = original;
    std::sort(sorted.begin(), sorted.end());
    for (int s = 0; s < options.samples; ++s) {
        GenericitySample sample;
        sample.seed = options.seed + static_cast<std::uint64_t>(s);
        std::mt19937_64 random(sample.seed);
        Packing<2> start = packing;
        for (double& r : start.radius) {
            const double u = static_cast<double>(random() >> 11) * 0x1p-52 - 1;
            r *= 1 + options.size * u;
        }
        PreparationOptions preparation;
        preparation.seed = sample.seed;
        preparation.stress = options.stress;
        PreparationReport<2> report;
        const auto state = find_vertex<2>(start, preparation, report);
        if (!state.ok()) {
            sample.failure = state.failure();
            out.samples.push_back(std::move(sample));
            continue;
        }
        sample.contacts = state.value().contacts;
        std::sort(sample.contacts.begin(), sample.contacts.end());
        const std::vector<Contact> carrying = carriers(state.value());
        sample.carrying = static_cast<int>(carrying.size());
        sample.rattlers = report.rattlers;
        sample.min_force = report.min_force;
        sample.min_gap = report.min_gap;
        sample.sigma_min_bound = report.sigma_min_bound;
        sample.within_original = std::all_of(carrying.begin(), carrying.end(), [&](const Contact& contact) {
            return std::binary_search(sorted.begin(), sorted.end(), contact);
        });
        ++out.proved;
        const auto known = std::find_if(out.lists.begin(), out.lists.end(),
                                        [&](const ContactListCount& list) { return list.contacts == sample.contacts; });
        if (known == out.lists.end()) {
            out.lists.push_back({sample.contacts, 1});
        } else {
            ++known->samples;
        }
        out.samples.push_back(std::move(sample));
    }
    std::stable_sort(out.lists.begin(), out.lists.end(),
                     [](const ContactListCount& a, const ContactListCount& b) { return a.samples > b.samples; });
    return out;
}

} // namespace isostat::crafted
