#include "io/state_json.hpp"

#include <cmath>

namespace isostat::json {

namespace {

Json terms(const std::vector<std::pair<Contact, Enclosure>>& list, int dimension) {
    Json rows = Json::array();
    for (const auto& [contact, term] : list) {
        rows.push_back(Json::array({contact_to_json(contact, dimension), term.value, term.radius}));
    }
    return rows;
}

Enclosure enclosure_from(const Field& value, const Field& bound) {
    if (bound.number() < 0) {
        bound.fail("a bound, which is not negative");
    }
    return {value.number(), bound.number()};
}

std::vector<std::pair<Contact, Enclosure>> terms_from(const Field& field, const Packing& packing) {
    std::vector<std::pair<Contact, Enclosure>> list;
    for (std::size_t k = 0; k < field.size(); ++k) {
        const Field row = field.at(k);
        row.require_size(3, "[contact, value, bound]");
        list.emplace_back(contact_from_json(row.at(std::size_t{0}), packing),
                          enclosure_from(row.at(std::size_t{1}), row.at(std::size_t{2})));
    }
    return list;
}

} // namespace

Json perturbation_to_json(const RadiusPerturbation& perturbation, int dimension) {
    Json object;
    object["seed"] = perturbation.seed;
    object["rho"] = perturbation.rho;
    if (perturbation.load_zero.i >= 0) {
        object["load_zero"] = contact_to_json(perturbation.load_zero, dimension);
        object["stress_rate"] = Json::array({perturbation.stress_rate.value, perturbation.stress_rate.radius});
    }
    if (!perturbation.open.empty()) {
        object["open"] = terms(perturbation.open, dimension);
    }
    if (!perturbation.zero.empty()) {
        object["zero"] = terms(perturbation.zero, dimension);
    }
    return object;
}

RadiusPerturbation perturbation_from_json(const Field& field, const Packing& packing) {
    field.only({"seed", "rho", "load_zero", "stress_rate", "open", "zero"});
    RadiusPerturbation perturbation;
    if (!field.at("seed").value().is_number_unsigned()) {
        field.at("seed").fail("an integer from 0 to 2^64 - 1");
    }
    perturbation.seed = field.at("seed").value().get<std::uint64_t>();
    const Field rho = field.at("rho");
    rho.require_size(packing.radius.size(), "one number per disk");
    for (std::size_t i = 0; i < rho.size(); ++i) {
        perturbation.rho.push_back(rho.at(i).number());
    }
    if (field.has("load_zero")) {
        perturbation.load_zero = contact_from_json(field.at("load_zero"), packing);
        const Field rate = field.at("stress_rate");
        rate.require_size(2, "[value, bound]");
        perturbation.stress_rate = enclosure_from(rate.at(std::size_t{0}), rate.at(std::size_t{1}));
    }
    if (field.has("open")) {
        perturbation.open = terms_from(field.at("open"), packing);
    }
    if (field.has("zero")) {
        perturbation.zero = terms_from(field.at("zero"), packing);
    }
    return perturbation;
}

} // namespace isostat::json
