#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/terminal.hpp"
#include "crafted/enclosed_bases.hpp"

#include <isostat/core/error.hpp>
#include <isostat/crafted/exact_packing.hpp>
#include <isostat/crafted/inspection.hpp>

#include <fmt/format.h>

#include <cmath>

namespace isostat::cli {

namespace {

constexpr int vectors_in_json = 10;
constexpr int vectors_in_text = 3;
constexpr std::size_t longest = 60; ///< components of a vector on the terminal

std::vector<std::string> dof_names(const crafted::ExactPacking& packing) {
    const DofMap<2> dofs(crafted::approximate(packing));
    std::vector<std::string> out;
    for (int dof = 0; dof < dofs.dof_count(); ++dof) {
        out.push_back(dofs.name(dof));
    }
    return out;
}

/// Components that are not 0 to the bound.
std::vector<std::size_t> visible(const crafted::EnclosedVector& vector) {
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < vector.value.size(); ++k) {
        if (std::abs(vector.value[k]) > vector.radius) {
            out.push_back(k);
        }
    }
    return out;
}

void print_enclosed(const crafted::ExactPacking& packing, const crafted::Inspection& inspection) {
    const crafted::EnclosedBases bases = crafted::enclose_bases(packing, inspection, vectors_in_text);
    if (bases.verdict != Verdict::proved) {
        say("bases                  too large to be exact, and no enclosure was proved\n");
        return;
    }
    const auto print = [](const char* kind, const std::vector<crafted::EnclosedVector>& vectors,
                          const std::vector<std::string>& names, std::size_t count) {
        for (std::size_t v = 0; v < vectors.size(); ++v) {
            say("{} {} of {}: every component within {:.1e}, those beyond it:", kind, v + 1, count, vectors[v].radius);
            const auto components = visible(vectors[v]);
            for (std::size_t k = 0; k < components.size() && k < longest; ++k) {
                say(" {}: {:.12g}{}", names[components[k]], vectors[v].value[components[k]],
                    k + 1 < components.size() ? "," : "");
            }
            say("{}\n", components.size() > longest ? fmt::format(" and {} more", components.size() - longest) : "");
        }
    };
    print("self-stress", bases.self_stresses, contact_names(inspection.contacts), bases.free_contacts.size());
    print("motion", bases.motions, dof_names(packing), bases.free_dofs.size());
}

Json enclosed_json(const crafted::ExactPacking& packing, const crafted::Inspection& inspection) {
    const crafted::EnclosedBases bases = crafted::enclose_bases(packing, inspection, vectors_in_json);
    const auto list = [](const std::vector<crafted::EnclosedVector>& vectors, const std::vector<std::string>& names) {
        Json out = Json::array();
        for (const crafted::EnclosedVector& vector : vectors) {
            Json entries = Json::array();
            for (const std::size_t k : visible(vector)) {
                entries.push_back({names[k], vector.value[k]});
            }
            out.push_back({{"free", names[static_cast<std::size_t>(vector.free)]},
                           {"radius", vector.radius},
                           {"entries", std::move(entries)}});
        }
        return out;
    };
    return {{"verdict", to_string(bases.verdict)},
            {"self_stresses", list(bases.self_stresses, contact_names(inspection.contacts))},
            {"motions", list(bases.motions, dof_names(packing))}};
}

} // namespace

int inspect_packing(const InspectArguments& arguments) {
    const crafted::PackingFile file = crafted::read_packing(arguments.file);
    const Result<crafted::Inspection> result = crafted::inspect(file.packing);
    if (!result.ok()) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: {}", arguments.file, result.failure().message()));
    }
    const crafted::Inspection& inspection = result.value();
    if (arguments.common.json) {
        Json out = Json::parse(crafted::to_json(inspection, file.packing));
        if (inspection.bases_exact != Verdict::proved) {
            out["enclosed_bases"] = enclosed_json(file.packing, inspection);
        }
        print_json(out);
    } else {
        say_lines(crafted::to_text(inspection, file.packing) + "\n");
        if (inspection.bases_exact != Verdict::proved) {
            print_enclosed(file.packing, inspection);
        }
    }
    const std::vector<std::string> differences = crafted::check_expected(inspection, file, arguments.file);
    for (const std::string& difference : differences) {
        say(stderr, "{}\n", difference);
    }
    if (!differences.empty()) {
        return failed;
    }
    return inspection.rank_exact == Verdict::proved ? done : undecided;
}

} // namespace isostat::cli
