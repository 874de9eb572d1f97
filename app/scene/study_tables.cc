#include "app/scene/common_tables.h"
#include "app/scene/scene_declare.h"

namespace annulus::app {

namespace {

constexpr const char* path_meaning =
    "the table and key of an input, as \"supports.planet_N_per_m\" or \"mesh.sun_planet.mean_N_per_m\"; \"ring.pins\" "
    "is that of every ring that has it, \"ring.NAME.pins\" that of one; \"errors.planet_eccentricity_um[2]\" is the "
    "value of planet 2, counted from 1.";

/// Values of studies are bounded as the widest key is; the key that is varied has bounds of its own.
constexpr int most_study_values = 10000;

/// Keys of one input and its values, their names behind a prefix.
Table row_of_values(const char* path, const char* meaning, const std::string& prefix,
                    SweepInput& (*section)(Scene&, std::size_t)) {
  Declarations<SweepInput> row(path, meaning, section);
  row.study();
  const auto name = [&](const char* key) { return prefix + key; };
  row.key(name("input").c_str(), &SweepInput::input, (std::string("What is varied: ") + path_meaning).c_str())
      .required();
  row.key(name("from").c_str(), &SweepInput::from, "First value, in the unit of the input.")
      .from(-1e14, 1e14)
      .absent("give values instead");
  row.key(name("to").c_str(), &SweepInput::to, "Last value, in the unit of the input.")
      .from(-1e14, 1e14)
      .absent("give values instead");
  row.key(name("count").c_str(), &SweepInput::count, "Number of values between these two, both included.")
      .from(2, most_study_values)
      .absent("give values instead");
  row.choice(name("scale").c_str(), &SweepInput::scale,
             {{"linear", SweepScale::linear}, {"logarithmic", SweepScale::logarithmic}},
             "Spacing of the values, and the axis of the plots.")
      .fallback(std::string("linear"), "equal steps");
  row.key(name("values").c_str(), &SweepInput::values, "The values themselves, in the unit of the input.")
      .from(-1e14, 1e14)
      .longest(most_study_values)
      .instead_of({name("from"), name("to"), name("count")})
      .absent("give from, to and count instead");
  Table table = row.done();
  table.repeated = true;
  return table;
}

Table sweep_table() {
  Table sweep = row_of_values(
      "sweep", "One input run through a row of values, for every ring; several tables are several sweeps.", "",
      [](Scene& s, std::size_t i) -> SweepInput& { return s.sweeps.at(i); });
  sweep.resize = [](Scene& s, std::size_t n) { s.sweeps.resize(n); };
  return sweep;
}

Table grid_table() {
  Table grid = row_of_values(
      "grid", "Two inputs run through all combinations of their values; several tables are several grids.", "x_",
      [](Scene& s, std::size_t i) -> SweepInput& { return s.grids.at(i).x; });
  const Table grid_y =
      row_of_values("grid", "", "y_", [](Scene& s, std::size_t i) -> SweepInput& { return s.grids.at(i).y; });
  grid.parameters.insert(grid.parameters.end(), grid_y.parameters.begin(), grid_y.parameters.end());
  grid.resize = [](Scene& s, std::size_t n) { s.grids.resize(n); };
  return grid;
}

Table monte_carlo_table() {
  Declarations<MonteCarloInput> monte_carlo(
      "monte_carlo",
      "Random samples of what is not known. Every ring gets the same draws. A draw depends on seed, sample number and "
      "input alone: not on the number of threads or samples.",
      [](Scene& s, std::size_t) -> MonteCarloInput& {
        if (!s.monte_carlo) s.monte_carlo.emplace();
        return *s.monte_carlo;
      });
  monte_carlo.study();
  monte_carlo.key("samples", &MonteCarloInput::samples, "Number of samples.").required().from(2, 1e6);
  monte_carlo.key("seed", &MonteCarloInput::seed, "Other seeds give other draws.")
      .fallback(1L, "any number will do")
      .from(0, 2147483647);
  monte_carlo
      .choice("phases", &MonteCarloInput::phases,
              {{"unknown", ErrorPhases::unknown}, {"prescribed", ErrorPhases::given, "given"}},
              "unknown: every error phase of every body is uniform over the full circle; prescribed: the phases of "
              "[errors].")
      .fallback(std::string("unknown"), "the phases of errors are hardly ever known");
  return monte_carlo.done();
}

Table random_input_table() {
  Declarations<RandomInput> random("monte_carlo.input",
                                   "A tolerance: an input that is not known exactly. It must leave the stiffness "
                                   "tables as they are. A draw outside the range of the key is refused, never moved.",
                                   [](Scene& s, std::size_t i) -> RandomInput& { return s.random_inputs.at(i); });
  random.repeated([](Scene& s, std::size_t n) { s.random_inputs.resize(n); })
      .study()
      .only_if(given("[monte_carlo]"), "it holds the number of samples");
  static const std::string random_input =
      std::string("What is uncertain: ") + path_meaning + " \"...[*]\" draws for every planet by itself.";
  random.key("input", &RandomInput::input, random_input.c_str()).required();
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
  Declarations<SensitivityInput> sensitivity(
      "sensitivity",
      "Each input divided and multiplied by a factor, one at a time: does the order of the rings change?",
      [](Scene& s, std::size_t) -> SensitivityInput& {
        if (!s.sensitivity) s.sensitivity.emplace();
        return *s.sensitivity;
      });
  sensitivity.study();
  static const std::string sensitivity_inputs = std::string("Which inputs; each is ") + path_meaning;
  sensitivity.key("inputs", &SensitivityInput::inputs, sensitivity_inputs.c_str())
      .fallback(
          std::vector<std::string>{},
          "the stiffnesses of [supports], the damping ratios and the backlash; of a 2K-V stage all stiffnesses and "
          "inertias besides");
  sensitivity.key("factor", &SensitivityInput::factor, "The factor.").fallback(2.0, "a usual doubt").above(1, 1e6);
  return sensitivity.done();
}

Table optimise_table() {
  Declarations<OptimiseInput> optimise(
      "optimise",
      "Inputs are searched for the best value of a result. A search interrupted goes on where it stopped; the same "
      "seed gives the same search.",
      [](Scene& s, std::size_t) -> OptimiseInput& {
        if (!s.optimise) s.optimise.emplace();
        return *s.optimise;
      });
  optimise.study();
  optimise
      .key("objective", &OptimiseInput::objective,
           "Results whose weighted sum is the objective: keys of results (annulus explain), as "
           "\"sun_planet_load_sharing_instantaneous\".")
      .required();
  optimise.key("weights", &OptimiseInput::weights, "One weight per result.")
      .fallback(std::vector<double>{}, "equal weights: the mean")
      .from(-1e14, 1e14);
  optimise
      .choice("goal", &OptimiseInput::goal, {{"smallest", Goal::smallest}, {"largest", Goal::largest}},
              "Which value is best.")
      .fallback(std::string("smallest"), "less is better");
  optimise
      .key("optimisers", &OptimiseInput::optimisers,
           "Any of genetic, cma_es, differential_evolution; several are compared.")
      .among({"genetic", "cma_es", "differential_evolution"})
      .fallback(std::vector<std::string>{"genetic", "cma_es"}, "the method of the literature and a modern one");
  optimise.key("generations", &OptimiseInput::generations, "Generations after the first population.")
      .fallback(200L, "as usual in the literature")
      .from(1, 1e5);
  optimise.key("population", &OptimiseInput::population, "Points of a generation; an even number.")
      .fallback(20L, "ten per input for two inputs")
      .from(6, 1e5);
  optimise.key("repeats", &OptimiseInput::repeats, "Searches by each optimiser, with seeds of their own.")
      .fallback(1L, "one")
      .from(1, 1000);
  optimise.key("seed", &OptimiseInput::seed, "Other seeds give other searches.")
      .fallback(1L, "any number will do")
      .from(0, 2147483647);
  optimise.key("elite", &OptimiseInput::elite, "genetic: share of the population that become parents.")
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
           "Initial conditions from which the motion is followed at the inputs of the scene and at the best ones: "
           "where teeth lose contact, more than one steady motion is possible.")
      .fallback(6L, "finds a second motion that is not rare")
      .from(0, 1000);
  return optimise.done();
}

Table variable_table() {
  Declarations<VariableInput> variable("optimise.variable", "An input that is searched.",
                                       [](Scene& s, std::size_t i) -> VariableInput& { return s.variables.at(i); });
  variable.repeated([](Scene& s, std::size_t n) { s.variables.resize(n); })
      .study()
      .only_if(given("[optimise]"), "it holds the objective");
  variable.key("input", &VariableInput::input, (std::string("What is searched: ") + path_meaning).c_str()).required();
  variable.key("low", &VariableInput::low, "Smallest value, in the unit of the input.").required().from(-1e14, 1e14);
  variable.key("high", &VariableInput::high, "Largest value, in the unit of the input.").required().from(-1e14, 1e14);
  variable
      .choice("scale", &VariableInput::scale,
              {{"linear", SweepScale::linear}, {"logarithmic", SweepScale::logarithmic}},
              "Scale on which the range is searched.")
      .fallback(std::string("linear"), "equal steps");
  return variable.done();
}

}  // namespace

std::vector<Table> study_tables() {
  return {sweep_table(),       grid_table(),     monte_carlo_table(), random_input_table(),
          sensitivity_table(), optimise_table(), variable_table()};
}

}  // namespace annulus::app
