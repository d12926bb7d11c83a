#pragma once

#include <memory>
#include <string>

// Formulas of x and y, for terrain heights.
namespace tread::scene
{

/// Elements that a formula may contain, for messages and documentation.
extern const char* const formula_language;

/// Why `text` is not a formula, naming the offending token; empty if it is one.
std::string formula_problem(const std::string& text);

/// Evaluates a formula. The same text gives the same numbers in every locale. Not thread-safe.
class FormulaEvaluator
{
public:
    /// InputError if the text is not a formula.
    explicit FormulaEvaluator(const std::string& text);
    ~FormulaEvaluator();
    FormulaEvaluator(FormulaEvaluator&&) noexcept;
    FormulaEvaluator& operator=(FormulaEvaluator&&) noexcept;
    FormulaEvaluator(const FormulaEvaluator&)            = delete;
    FormulaEvaluator& operator=(const FormulaEvaluator&) = delete;

    /// Value at x and y (m); may be NaN or infinite.
    double operator()(double x, double y);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace tread::scene
