#include "contact/words.hpp"
#include "io/json.hpp"
#include "packing/bodies.hpp"

#include <isostat/crafted/exact_packing.hpp>

namespace isostat::crafted {

namespace {

using json::Json;

Json entries(const std::vector<Number>& vector, const std::vector<std::string>& names) {
    Json out = Json::array();
    for (std::size_t k = 0; k < vector.size(); ++k) {
        if (!vector[k].is_zero()) {
            out.push_back({names[k], vector[k].text()});
        }
    }
    return out;
}

/// Adds the entries that only a periodic cell has.
void add_cell(const Inspection& inspection, Json& out) {
    if (inspection.strains) {
        out["strains"] = json::counts(*inspection.strains);
    }
    if (inspection.jamming) {
        out["jammed"] = {
            {"disks", inspection.jamming->disks},
            {"collective", to_string(inspection.jamming->collective)},
            {"strict", inspection.jamming->strict ? Json(to_string(*inspection.jamming->strict)) : Json()}};
    }
}

Json ranges_json(const Inspection& inspection, const std::vector<std::string>& contacts,
                 const std::vector<std::string>& coordinates) {
    const auto end = [](const std::optional<Number>& force) { return force ? Json(force->text()) : Json(nullptr); };
    const auto name = [&](int l) { return contacts[static_cast<std::size_t>(l)]; };
    return json::array_of(inspection.ranges, [&](const LoadRange& range) {
        return Json{{"on", coordinates[static_cast<std::size_t>(range.dof)]},
                    {"least", end(range.least)},
                    {"most", end(range.most)},
                    {"zero_at_least", json::array_of(range.zero_at_least, name)},
                    {"zero_at_most", json::array_of(range.zero_at_most, name)}};
    });
}

/// The names whose flag is set, or is not set, as `set` requires.
template <class Flags> Json flagged(const std::vector<std::string>& names, const Flags& flags, bool set) {
    Json out = Json::array();
    for (std::size_t l = 0; l < flags.size(); ++l) {
        if ((flags[l] != 0) == set) {
            out.push_back(names[l]);
        }
    }
    return out;
}

} // namespace

std::string to_json(const Inspection& inspection, const ExactPacking& packing) {
    const std::vector<std::string> contacts = contact_names(inspection.contacts, packing.dimension());
    const std::vector<std::string> coordinates = dof_names(approximate(packing));
    Json out;
    out["format"] = "isostat-inspection 1";
    if (packing.dimension() != plane) {
        out["dimension"] = packing.dimension();
    }
    out["disks"] = packing.disk_count();
    out["N_f"] = inspection.dof_count;
    out["N"] = inspection.contact_count();
    out["rank"] = inspection.rank;
    out["rank_exact"] = to_string(inspection.rank_exact);
    out["h"] = inspection.hyperstaticity;
    out["k"] = inspection.mechanisms;
    out["rigid_motions"] = inspection.rigid_motions;
    out["verdict"] = inspection.verdict();
    out["generic_rank"] = inspection.generic_rank;
    out["special"] = to_string(inspection.special_position);
    out["rank_with_radii"] = inspection.with_radii.rank;
    out["rank_with_radii_exact"] = to_string(inspection.with_radii.rank_exact);
    add_cell(inspection, out);
    out["contacts"] = std::vector(contacts.begin(), contacts.begin() + inspection.contact_count());
    if (!packing.bars.empty()) {
        out["bodies"] = Bodies(approximate(packing)).members();
    }
    out["hold"] = json::array_of(inspection.hold, [](DiskHold hold) { return to_string(hold); });
    out["contacts_without_force"] = flagged(contacts, inspection.carrying, false);
    out["one_sign"] = inspection.one_sign_decided ? to_string(inspection.one_sign.kind) : "undecided";
    out["one_sign_stress"] = entries(inspection.one_sign.combination, contacts);
    out["support"] = to_string(inspection.support);
    out["forces_unique"] = inspection.forces_unique;
    out["without_force"] = inspection.without_force;
    out["forces"] = entries(inspection.forces, contacts);
    out["ranges"] = ranges_json(inspection, contacts, coordinates);
    out["structural_zeros"] = flagged(contacts, inspection.structural_zero, true);
    out["second_order"] = to_string(inspection.second_order);
    out["stable"] = to_string(inspection.stable);
    out["bases_exact"] = to_string(inspection.bases_exact);
    out["self_stresses"] =
        json::array_of(inspection.self_stresses, [&](const auto& stress) { return entries(stress, contacts); });
    out["motions"] =
        json::array_of(inspection.motions, [&](const auto& motion) { return entries(motion, coordinates); });
    return out.dump(2);
}

} // namespace isostat::crafted
