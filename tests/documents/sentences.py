#!/usr/bin/env python3
"""Sentences of documents: their lengths, and words that the project does not use.

    sentences.py [--list] FILE.md ...

Prints, of every page, the number of sentences, the median and the largest number of words. Every sentence above the
limit and every unused word is an error, with its line. Code blocks, headings, formulas and references are left out;
items of lists and cells of tables count as sentences of their own. Inline code counts as one word.
"""
import re
import statistics
import sys

LONGEST = 30  # words
UNUSED = {  # word: what is used
    r"freedoms?(?<!of freedom)": "degree of freedom",
    r"rungs?": "fidelity, model",
    r"dear": "expensive",
    r"foul(s|ed)?": "interfere",
    r"alike": "equal",
    r"figures? of merit": "result",
    r"hangs on": "is supported by",
    r"misplacement": "pin position error",
    r"parting": "tooth separation",
    r"marching|marched": "time integration",
    r"likeness": "modal assurance criterion",
}
ABBREVIATIONS = r"\b(?:e\.g|i\.e|eqs?|figs?|vol|no|p|pp|sec|et al|cf|approx)\."


def plain(text):
    """Without marks: links by their text, inline code as one word."""
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)", "", text)
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"\\\|", "¦", text)
    text = re.sub(r"`[^`]*`", "code", text)
    text = re.sub(r"\$[^$]*\$", "formula", text)
    text = re.sub(r"<[^>]+>", "", text)
    return text.replace("**", "").replace("__", "")


def paragraphs(lines):
    """(line, text) of every paragraph, item and cell."""
    text, start, code = [], 0, False

    def flush():
        nonlocal text
        found = [(start, " ".join(text))] if text else []
        text = []
        return found

    for number, line in enumerate(lines, 1):
        if line.lstrip().startswith(("```", "~~~")):
            yield from flush()
            code = not code
            continue
        stripped = line.strip()
        indented = line.startswith("    ") and not text
        if code or indented or not stripped or stripped.startswith(("#", "<!--", "$$", "![")):
            yield from flush()
            continue
        if stripped.startswith("|"):
            yield from flush()
            if not re.fullmatch(r"[|:\- ]+", stripped):
                for cell in plain(stripped).strip("|").split("|"):  # rules of a key, one after the other
                    yield from ((number, part.strip()) for part in cell.split(";"))
            continue
        item = re.match(r"(?:[-*+]|\d+\.)\s+", stripped)
        if item or stripped.startswith(">"):
            yield from flush()
            stripped = stripped[item.end() :] if item else stripped[1:].strip()
        if not text:
            start = number
        text.append(stripped)
        if line.endswith("  "):  # a break
            yield from flush()
    yield from flush()


def sentences(text):
    text = re.sub(ABBREVIATIONS, lambda m: m.group(0).replace(".", "․"), plain(text), flags=re.I)
    for sentence in re.split(r"(?<=[.!?])[)\"”]*\s+(?=[\w(\"“'*])", text):
        words = [w for w in sentence.split() if re.search(r"[^\W\d_]", w)]
        if words:
            yield len(words), sentence.strip()


def main(arguments):
    listing = "--list" in arguments
    errors = 0
    print(f"{'page':40} sentences  median  longest")
    for name in (a for a in arguments if a != "--list"):
        lengths = []
        with open(name, encoding="utf-8") as file:
            found = list(paragraphs(file.read().splitlines()))
        for line, text in found:
            for count, sentence in sentences(text):
                lengths.append(count)
                if count > LONGEST:
                    errors += 1
                    if listing:
                        print(f"{name}:{line}: {count} words: {sentence}")
            for pattern, instead in UNUSED.items():
                for match in re.finditer(rf"\b(?:{pattern})\b", plain(text), flags=re.I):
                    errors += 1
                    if listing:
                        print(f"{name}:{line}: '{match.group(0)}' is not used here: {instead}")
        if lengths:
            print(f"{name:40} {len(lengths):9} {statistics.median(lengths):7.0f} {max(lengths):8}")
    if errors:
        print(f"{errors} sentences above {LONGEST} words or with words that are not used")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
