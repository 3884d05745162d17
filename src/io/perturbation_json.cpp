#include "io/state_json.hpp"

#include <cmath>

namespace isostat::json {

namespace {

template <int Dim> Json terms(const std::vector<std::pair<Contact, Enclosure>>& list) {
    Json rows = Json::array();
    for (const auto& [contact, term] : list) {
        rows.push_back(Json::array({contact_to_json<Dim>(contact), term.value, term.radius}));
    }
    return rows;
}

Enclosure enclosure_from(const Field& value, const Field& bound) {
    if (bound.number() < 0) {
        bound.fail("a bound, which is not negative");
    }
    return {value.number(), bound.number()};
}

template <int Dim>
std::vector<std::pair<Contact, Enclosure>> terms_from(const Field& field, const Packing<Dim>& packing) {
    std::vector<std::pair<Contact, Enclosure>> list;
    for (std::size_t k = 0; k < field.size(); ++k) {
        const Field row = field.at(k);
        row.require_size(3, "[contact, value, bound]");
        list.emplace_back(contact_from_json<Dim>(row.at(std::size_t{0}), packing),
                          enclosure_from(row.at(std::size_t{1}), row.at(std::size_t{2})));
    }
    return list;
}

} // namespace

template <int Dim> Json perturbation_to_json(const RadiusPerturbation& perturbation) {
    Json object;
    object["seed"] = perturbation.seed;
    object["rho"] = perturbation.rho;
    if (perturbation.load_zero.i >= 0) {
        object["load_zero"] = contact_to_json<Dim>(perturbation.load_zero);
        object["stress_rate"] = Json::array({perturbation.stress_rate.value, perturbation.stress_rate.radius});
    }
    if (!perturbation.open.empty()) {
        object["open"] = terms<Dim>(perturbation.open);
    }
    if (!perturbation.zero.empty()) {
        object["zero"] = terms<Dim>(perturbation.zero);
    }
    return object;
}

template <int Dim> RadiusPerturbation perturbation_from_json(const Field& field, const Packing<Dim>& packing) {
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
        perturbation.load_zero = contact_from_json<Dim>(field.at("load_zero"), packing);
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

template Json perturbation_to_json<2>(const RadiusPerturbation&);
template RadiusPerturbation perturbation_from_json<2>(const Field&, const Packing<2>&);

} // namespace isostat::json
