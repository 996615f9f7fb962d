"""Reads the comments of C++ and Python: none begins as a fragment, and no sentence has more than 25 words."""
from __future__ import annotations
import io, re, sys, tokenize
from pathlib import Path

FRAGMENT = re.compile(r"(Of|What|Where|Likewise)\b")
LONGEST = 25
WORD = re.compile(r"[A-Za-z][\w'’-]*")

def cpp_blocks(text):
    block, first, kind = [], 0, None
    for number, line in enumerate(text.splitlines(), 1):
        m = re.match(r"\s*(///?)(?!<)(.*)$", line)
        if m:
            if not block: first = number
            block.append(m[2]); continue
        if block: yield first, block; block = []
        m = re.search(r"(///<|(?<![:\"'])// )(.*)$", line)
        if m: yield number, [" "+m[2].strip()]
    if block: yield first, block

def python_blocks(text):
    previous = None
    run, first, last = [], 0, -1
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            if token.start[0] == last + 1 and run: run.append(token.string.lstrip("#"))
            else:
                if run: yield first, run
                run, first = [token.string.lstrip("#")], token.start[0]
            last = token.start[0]
        if token.type == tokenize.STRING and (previous is None or previous.type in (tokenize.INDENT, tokenize.NEWLINE, tokenize.NL, tokenize.DEDENT, tokenize.ENCODING)) and token.string.lstrip("rbuf").startswith('"""'):
            yield token.start[0], [l.strip() and " "+l.strip() if i==0 else l for i,l in enumerate(token.string.strip('rf"').splitlines())]
        if token.type not in (tokenize.COMMENT,tokenize.NL): previous = token
    if run: yield first, run

def sentences(block):
    """Prose alone: lines that are indented further, tables and formulas are none."""
    paragraph=[]
    def out():
        text=" ".join(paragraph); paragraph.clear()
        for s in re.split(r"(?<=[.!?;:])\s+(?=[A-Z`])", text):
            if s.strip(): yield s.strip()
    for line in block:
        body=line.rstrip()
        if not body.strip() or re.match(r"\s*(```|\||- |\d\.)",body) or re.match(r"\s{2,}",body) or re.search(r"[=←≤∫Σ→]|\S {2,}\S",body):
            yield from out(); continue
        paragraph.append(body.strip())
    yield from out()

def problems(path):
    text=path.read_text()
    blocks = python_blocks(text) if path.suffix != ".h" and path.suffix!=".cpp" else cpp_blocks(text)
    for number, block in blocks:
        for s in sentences(block):
            if FRAGMENT.match(s): yield number, "fragment", s
            n=len(WORD.findall(s))
            if n>LONGEST: yield number, f"{n} words", s

if __name__=="__main__":
    c={}
    for a in sys.argv[1:]:
        for n,k,s in problems(Path(a)):
            key="fragment" if k=="fragment" else "long"; c[key]=c.get(key,0)+1
            print(f"{a}:{n}: {k}: {s[:110]}")
    print(c)
