#include "app/scene/common_tables.h"
#include "app/scene/scene_declare.h"

namespace annulus::app {

namespace {

constexpr const char* path_meaning =
    "the table and key of an input, such as \"supports.planet_N_per_m\" or \"mesh.sun_planet.mean_N_per_m\". "
    "\"ring.pins\" means the key of every ring that has it, \"ring.NAME.pins\" the key of one ring; so for "
    "[[bearing]] and [[load]]. "
    "\"errors.planet_eccentricity_um[2]\" means the value of planet 2, counted from 1.";

const std::vector<Choice<SweepScale>> scales = {{"linear", SweepScale::linear},
                                                {"logarithmic", SweepScale::logarithmic}};

const std::vector<Choice<SweepDirection>> directions = [] {
  std::vector<Choice<SweepDirection>> list;
  for (std::size_t i = 0; i < direction_names.size(); ++i)
    list.push_back({direction_names.at(i), static_cast<SweepDirection>(i)});
  return list;
}();

/// Values of studies are bounded as the widest key is; the key that is varied has bounds of its own.
constexpr int most_study_values = 10000;

/// Keys of one input and its values, their names behind a prefix.
void declare_row(Declarations<SweepInput>& row, const std::string& prefix) {
  row.study();
  row.key(prefix + "input", &SweepInput::input, std::string("Input to vary: ") + path_meaning).required();
  row.key(prefix + "from", &SweepInput::from, "First value, in the unit of the input.")
      .from(-1e14, 1e14)
      .absent("give values instead");
  row.key(prefix + "to", &SweepInput::to, "Last value, in the unit of the input.")
      .from(-1e14, 1e14)
      .absent("give values instead");
  row.key(prefix + "count", &SweepInput::count, "Number of values from the first to the last, both included.")
      .from(2, most_study_values)
      .absent("give values instead");
  row.choice(prefix + "scale", &SweepInput::scale, scales, "Spacing of the values, and scale of the plots.")
      .fallback("linear", "equal steps");
  row.key(prefix + "values", &SweepInput::values, "The values themselves, in the unit of the input.")
      .from(-1e14, 1e14)
      .longest(most_study_values)
      .not_empty("value")
      .distinct()
      .instead_of({prefix + "from", prefix + "to", prefix + "count"})
      .absent("give from, to and count instead");
}

Table sweep_table() {
  Declarations<SweepInput> row(
      "sweep", "One input takes a row of values, for every ring. Several tables are several sweeps.", &Scene::sweeps);
  declare_row(row, "");
  row.choice("direction", &SweepInput::direction, directions,
             "How the motion of each value is found. each: by itself. up, down: in time from that of the value before, "
             "in rising or falling order, as when a machine runs up or down. both: up and down. branches: both, and "
             "the branches of periodic motions between the ends, stable or not, with the values at which they jump.")
      .fallback("each", "values do not depend on each other");
  return row.done();
}

Table grid_table() {
  const auto axis = [](SweepInput GridInput::*member) {
    return Declarations<SweepInput>(
        "grid", "Two inputs take all combinations of their values. Several tables are several grids.",
        [member](Scene& s, std::size_t i) -> SweepInput& { return s.grids.at(i).*member; },
        [](Scene& s, std::size_t n) { s.grids.resize(n); });
  };
  auto x_axis = axis(&GridInput::x), y_axis = axis(&GridInput::y);
  declare_row(x_axis, "x_");
  declare_row(y_axis, "y_");
  Table grid = x_axis.done(), y = y_axis.done();
  std::move(y.parameters.begin(), y.parameters.end(), std::back_inserter(grid.parameters));
  return grid;
}

Table load_spectrum_table() {
  Declarations spectrum("load_spectrum",
                        "Classes of load, each with the time that it lasts. Every class is a response of its own; over "
                        "all of them results have their largest value and their mean over the time.",
                        &Scene::load_spectrum);
  spectrum.study();
  spectrum
      .key("inputs", &LoadSpectrumInput::inputs,
           std::string("Inputs that change from class to class, torque and speed say: ") + path_meaning)
      .not_empty("input")
      .required();
  return spectrum.done();
}

Table load_class_table() {
  Declarations load("load_spectrum.class", "A class of the load spectrum.", &Scene::load_classes);
  load.study().only_if(given("[load_spectrum]"), "it contains the inputs");
  load.key("name", &LoadClassInput::name, "Name in results.").required();
  load.key("duration_h", &LoadClassInput::duration, "How long the class lasts.").required().above(0, 1e9);
  load.key("values", &LoadClassInput::values, "Values of load_spectrum.inputs in their order and units.")
      .from(-1e14, 1e14)
      .not_empty("value")
      .required();
  return load.done();
}

Table transient_table() {
  Declarations transient(
      "transient",
      "Speed and torque that change in time: start, run-up, run-down, stop, overload, reversal of the "
      "torque or of the rotation. Several tables are several courses. Each begins from the steady "
      "motion at its first speed and torque; both are straight between their points.",
      &Scene::transients);
  transient.study();
  const auto list = [&](const char* name, auto member, const char* meaning) {
    return transient.key(name, member, meaning).longest(most_study_values).not_empty("value");
  };
  transient.key("name", &TransientInput::name, "Name in results.").required();
  list("time_s", &TransientInput::time, "Times of the points, rising from 0.").from(0, 1e6).required();
  list("speed_factor", &TransientInput::speed,
       "Speed at each time, over that of [stage]. 0: a standstill. Below 0 everything turns the other way round.")
      .from(-10, 10)
      .absent("1 throughout");
  list("torque_factor", &TransientInput::torque,
       "Torque at each time, over that of [stage]. Below 0 it acts the other way round, through back flanks.")
      .from(-10, 10)
      .absent("1 throughout");
  transient
      .choice("inertia_turned_by", &TransientInput::accelerated_by,
              {{"drive", dynamics::AcceleratedBy::drive}, {"load", dynamics::AcceleratedBy::load}},
              "Torque that turns the inertias faster, beside torque_factor. drive: that of the driving bodies (a motor "
              "runs up). load: that of the driven ones (a load that pulls along, or brakes).")
      .fallback("drive", "a motor runs up");
  return transient.done();
}

Table monte_carlo_table() {
  Declarations monte_carlo(
      "monte_carlo",
      "Random samples of unknown inputs. Every ring gets the same draws. A draw depends only on seed, sample number "
      "and input, not on the number of threads or samples. Without this table, 20 samples are drawn if the scene does "
      "not state the phases of its errors, or lists them as assumed.",
      &Scene::monte_carlo);
  monte_carlo.study();
  monte_carlo.key("samples", &MonteCarloInput::samples, "Number of samples; 0: none.").required().from(0, 1e6);
  monte_carlo.key("seed", &MonteCarloInput::seed, "Other seeds give other draws.")
      .fallback(1, "any number")
      .from(0, 2147483647);
  monte_carlo
      .choice("phases", &MonteCarloInput::phases,
              {{"unknown", ErrorPhases::unknown}, {"prescribed", ErrorPhases::given, "given"}},
              "unknown: every error phase of every body is uniform over the full circle; prescribed: the phases of "
              "[errors].")
      .fallback("unknown", "the phases of errors are seldom known");
  return monte_carlo.done();
}

Table random_input_table() {
  Declarations random("monte_carlo.input",
                      "A tolerance: an input that is not known exactly. It must not change the stiffness tables. A "
                      "draw outside the range of the key is refused, not moved into the range.",
                      &Scene::random_inputs);
  random.study().only_if(given("[monte_carlo]"), "it contains the number of samples");
  random
      .key("input", &RandomInput::input,
           std::string("Uncertain input: ") + path_meaning + " \"...[*]\" draws a separate value for every planet.")
      .required();
  random
      .choice("distribution", &RandomInput::distribution,
              {{"uniform", RandomKind::uniform}, {"normal", RandomKind::normal}, {"lognormal", RandomKind::lognormal}},
              "uniform between low and high; normal or lognormal with mean and deviation (of the value itself), "
              "truncated to low and high where given.")
      .required();
  random.key("low", &RandomInput::low, "Lower end, in the unit of the input.")
      .from(-1e14, 1e14)
      .required_if(is("distribution", {"uniform"}))
      .absent("not truncated");
  random.key("high", &RandomInput::high, "Upper end, in the unit of the input.")
      .from(-1e14, 1e14)
      .required_if(is("distribution", {"uniform"}))
      .absent("not truncated");
  random.key("mean", &RandomInput::mean, "Mean before truncation.")
      .from(-1e14, 1e14)
      .needed_if(is("distribution", {"normal", "lognormal"}));
  random.key("deviation", &RandomInput::deviation, "Standard deviation before truncation.")
      .above(0, 1e14)
      .needed_if(is("distribution", {"normal", "lognormal"}));
  return random.done();
}

Table sensitivity_table() {
  Declarations sensitivity("sensitivity",
                           "Each input is divided and multiplied by a factor, one at a time. The report states if the "
                           "order of the rings changes.",
                           &Scene::sensitivity);
  sensitivity.study();
  sensitivity.key("inputs", &SensitivityInput::inputs, std::string("Inputs to change; each is ") + path_meaning)
      .fallback(std::vector<std::string>{},
                "the stiffnesses of [supports], the damping ratios and the backlash; for a 2K-V stage also all "
                "stiffnesses and inertias");
  sensitivity.key("factor", &SensitivityInput::factor, "The factor.")
      .fallback(2.0, "a usual uncertainty")
      .above(1, 1e6);
  return sensitivity.done();
}

Table optimise_table() {
  Declarations optimise("optimise",
                        "Search for the inputs that give the best value of a result. An interrupted search continues "
                        "where it stopped. The same seed gives the same search.",
                        &Scene::optimise);
  optimise.study();
  optimise
      .key("objective", &OptimiseInput::objective,
           "Results whose weighted sum is the objective: keys of results (annulus explain), such as "
           "\"sun_planet_load_sharing_instantaneous\".")
      .not_empty("result")
      .required();
  optimise.key("weights", &OptimiseInput::weights, "One weight per result.")
      .fallback(std::vector<double>{}, "equal weights: the mean")
      .from(-1e14, 1e14);
  optimise
      .choice("goal", &OptimiseInput::goal, {{"smallest", Goal::smallest}, {"largest", Goal::largest}},
              "Best value of the objective.")
      .fallback("smallest", "less is better");
  optimise
      .key("optimisers", &OptimiseInput::optimisers,
           "Any of genetic, cma_es, differential_evolution; several are compared.")
      .among({"genetic", "cma_es", "differential_evolution"})
      .not_empty("optimiser")
      .fallback(std::vector<std::string>{"genetic", "cma_es"}, "the method of the literature and a modern one");
  optimise.key("generations", &OptimiseInput::generations, "Generations after the first population.")
      .fallback(200, "as usual in the literature")
      .from(1, 1e5);
  optimise.key("population", &OptimiseInput::population, "Points of a generation; an even number.")
      .fallback(20, "ten per input for two inputs")
      .from(6, 1e5);
  optimise.key("repeats", &OptimiseInput::repeats, "Number of searches by each optimiser, each with its own seed.")
      .fallback(1, "one")
      .from(1, 1000);
  optimise.key("seed", &OptimiseInput::seed, "Other seeds give other searches.")
      .fallback(1, "any number")
      .from(0, 2147483647);
  optimise.key("elite", &OptimiseInput::elite, "genetic: share of the population that becomes parents.")
      .fallback(0.2, "as usual in the literature")
      .above(0, 1);
  optimise.key("crossover", &OptimiseInput::crossover, "genetic: probability that a pair of parents is crossed.")
      .fallback(0.9, "as usual in the literature")
      .from(0, 1);
  optimise.key("mutation", &OptimiseInput::mutation, "genetic: probability that a value mutates.")
      .fallback(0.05, "as usual in the literature")
      .from(0, 1);
  optimise
      .key("initial_conditions", &OptimiseInput::starts,
           "Number of initial conditions from which the motion is computed, with the inputs of the scene and with the "
           "best inputs. If teeth lose contact, more than one steady motion is possible.")
      .fallback(6, "enough to find a second motion that is not rare")
      .from(0, 1000);
  return optimise.done();
}

Table variable_table() {
  Declarations variable("optimise.variable", "An input that is searched.", &Scene::variables);
  variable.study().only_if(given("[optimise]"), "it contains the objective");
  variable.key("input", &VariableInput::input, std::string("Input to search: ") + path_meaning).required();
  variable.key("low", &VariableInput::low, "Smallest value, in the unit of the input.").required().from(-1e14, 1e14);
  variable.key("high", &VariableInput::high, "Largest value, in the unit of the input.").required().from(-1e14, 1e14);
  variable.choice("scale", &VariableInput::scale, scales, "Scale on which the range is searched.")
      .fallback("linear", "equal steps");
  return variable.done();
}

}  // namespace

std::vector<Table> study_tables() {
  return {sweep_table(),       grid_table(),         load_spectrum_table(), load_class_table(), transient_table(),
          monte_carlo_table(), random_input_table(), sensitivity_table(),   optimise_table(),   variable_table()};
}

}  // namespace annulus::app
