# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the program says, line by line, and which moves each line makes: for lists that follow and seek.

Line numbers count commands within their operation from 1, as in the MoveTable; an operation's lines are those of its
tool controller, where that is played, and then its own. Texts are made when they are asked for: a list shows few.
"""

import bisect

from . import moves, program

# Words that come first in a line, in this order; the rest follows by the alphabet.
WORD_ORDER = "XYZABCIJKRPQF"


def text_of(name, words):
    """A command as a machinist reads it: lengths in mm, feeds in mm/min (Path's own are mm/s)."""
    if program.is_comment(name):
        return name.strip()
    order = {letter: index for index, letter in enumerate(WORD_ORDER)}
    result = [name]
    for letter, value in sorted(words.items(), key=lambda word: (order.get(word[0], len(order)), word[0])):
        if letter == "F" and value == 0.0:  # what Path writes into rapids
            continue
        number = ("%.4f" % (value * 60.0 if letter == "F" else value)).rstrip("0").rstrip(".")
        result.append(letter + ("0" if number == "-0" else number))
    return " ".join(result)


class Listing:
    """Lines of a MoveTable and its core.program Operations; read only, any thread.

    Line i: texts by text(i), its moves are [begin[i], begin[i + 1]) - none for comments. operation[i] is its operation,
    number[i] the command's number in it (0: the heading that names the operation; negative: its tool controller's).
    """

    def __init__(self, table, operations):
        self.operations = operations
        self.begin, self.operation, self.number = [], [], []
        ends = self._ends(table, len(operations))
        self.operation_begin = [0] + ends
        first = 0
        for index, operation in enumerate(operations):
            self._add(table, index, operation, first, ends[index])
            first = ends[index]
        self.begin.append(len(table))

    @staticmethod
    def _ends(table, count):
        """Number of moves up to the end of each operation."""
        ends, index = [0] * count, 0
        for index in range(len(table)):
            ends[table.sections[int(table.row(index)[2])][1]] = index + 1
        last = 0
        for operation in range(count):
            last = max(last, ends[operation])
            ends[operation] = last
        return ends

    def _add(self, table, index, operation, first, end):
        """Lines of one operation, whose moves are [first, end). The controller's come first: they end where the
        numbers of commands begin anew or, its last being the change of tool, after that."""
        own = first
        if operation.tool_commands and first < end:
            row = table.row(first)
            if row[0] == moves.EVENT and row[1] == moves.TOOL_CHANGE:
                own = first + 1
        self._line(index, 0, first)
        played = own > first
        for part, commands, begin, stop in ((-1, operation.tool_commands if played else (), first, own),
                                            (1, operation.commands, own, end)):
            move = begin
            for number in range(1, len(commands) + 1):
                while move < stop and table.row(move)[3] < number:
                    move += 1
                self._line(index, part * number, move)

    def _line(self, operation, number, begin):
        self.operation.append(operation)
        self.number.append(number)
        self.begin.append(begin)

    def __len__(self):
        return len(self.number)

    def moves_of(self, line):
        """(first, end) of the moves a line makes."""
        return self.begin[line], max(self.begin[line], self.begin[line + 1])

    def line_of(self, move):
        """The line that makes a move."""
        return max(bisect.bisect_right(self.begin, move, 0, len(self)) - 1, 0)

    def operation_at(self, move):
        """The operation of a move."""
        return min(max(bisect.bisect_right(self.operation_begin, move) - 1, 0), len(self.operations) - 1)

    def text(self, line):
        """What a line says."""
        operation, number = self.operations[self.operation[line]], self.number[line]
        if number == 0:
            return operation.name
        command = operation.tool_commands[-number - 1] if number < 0 else operation.commands[number - 1]
        return text_of(command.Name, {letter.upper(): float(value)
                                      for letter, value in dict(command.Parameters).items()})

    def next_line(self, place):
        """Where the line that is under way at this place ends."""
        last = self.begin[-1]
        return float(last) if place >= last else float(self.moves_of(self.line_of(int(place)))[1])

    def previous_line(self, place):
        """Where the line before this place, or the one it stands in, begins."""
        if place <= 0:
            return 0.0
        move = int(place) if place != int(place) else int(place) - 1
        return float(self.begin[self.line_of(move)])

    def next_operation(self, place):
        """Where the next operation begins, or the end."""
        at = bisect.bisect_right(self.operation_begin, place)
        return float(self.operation_begin[at]) if at < len(self.operation_begin) else float(self.begin[-1])

    def previous_operation(self, place):
        """Where the operation that is under way began, or the one before."""
        at = bisect.bisect_left(self.operation_begin, place) - 1
        return float(self.operation_begin[max(at, 0)])
