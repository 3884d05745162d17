#include "contact/names.hpp"
#include "crafted/enclosed_bases.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace isostat::crafted {

namespace {

using Json = nlohmann::ordered_json;

constexpr int vectors_in_json = 10;
constexpr int vectors_in_text = 3;
constexpr std::size_t longest = 60; ///< components of a vector shown on the terminal

/// The components that the bound distinguishes from 0.
std::vector<std::size_t> visible(const EnclosedVector& vector) {
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < vector.value.size(); ++k) {
        if (std::abs(vector.value[k]) > vector.radius) {
            out.push_back(k);
        }
    }
    return out;
}

} // namespace

std::string enclosed_text(const ExactPacking& packing, const Inspection& inspection) {
    const EnclosedBases bases = enclose_bases(packing, inspection, vectors_in_text);
    if (bases.verdict != Verdict::proved) {
        return "bases                  too large to be exact, and no enclosure was proved\n";
    }
    std::string out;
    const auto print = [&out](const char* kind, const std::vector<EnclosedVector>& vectors,
                              const std::vector<std::string>& names, std::size_t count) {
        for (std::size_t v = 0; v < vectors.size(); ++v) {
            out += fmt::format("{} {} of {}: every component within {:.1e}, those beyond it:", kind, v + 1, count,
                               vectors[v].radius);
            const auto components = visible(vectors[v]);
            for (std::size_t k = 0; k < components.size() && k < longest; ++k) {
                out += fmt::format(" {}: {:.12g}{}", names[components[k]], vectors[v].value[components[k]],
                                   k + 1 < components.size() ? "," : "");
            }
            out += components.size() > longest ? fmt::format(" and {} more\n", components.size() - longest) : "\n";
        }
    };
    print("self-stress", bases.self_stresses, contact_names(inspection.contacts, packing.dimension()),
          bases.free_contacts.size());
    print("motion", bases.motions, dof_names(approximate(packing)), bases.free_dofs.size());
    return out;
}

std::string enclosed_json(const ExactPacking& packing, const Inspection& inspection) {
    const EnclosedBases bases = enclose_bases(packing, inspection, vectors_in_json);
    const auto list = [](const std::vector<EnclosedVector>& vectors, const std::vector<std::string>& names) {
        Json out = Json::array();
        for (const EnclosedVector& vector : vectors) {
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
    const Json object{
        {"verdict", to_string(bases.verdict)},
        {"self_stresses", list(bases.self_stresses, contact_names(inspection.contacts, packing.dimension()))},
        {"motions", list(bases.motions, dof_names(approximate(packing)))}};
    return object.dump();
}

} // namespace isostat::crafted
