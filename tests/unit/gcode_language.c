/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* G-code as a language: expressions against C, parameters, O words, calls, limits, messages. */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The X of the last move, NAN with a message if there is none. */
static double run_with(const swarf_gcode_options *options, const char *text)
{
    swarf_program *program = NULL;
    double x = NAN;
    if (swarf_gcode_read(text, strlen(text), "t", options, NULL, &program) != SWARF_OK)
        fprintf(stderr, "  in: %s\n  %s\n", text, swarf_error_last());
    else if (swarf_program_move_count(program))
        x = swarf_program_moves(program)[swarf_program_move_count(program) - 1].end[0];
    swarf_program_release(program);
    return x;
}

static double run(const char *text)
{
    return run_with(NULL, text);
}

static void refuse(const char *text, const char *part)
{
    swarf_program *program = NULL;
    if (!CHECK_FAILS(swarf_gcode_read(text, strlen(text), "t", NULL, NULL, &program), SWARF_ERROR_FORMAT, part))
        fprintf(stderr, "  in: %s\n", text);
    swarf_program_release(program);
}

static void test_expressions(void)
{
    static const struct {
        const char *text;
        double value;
    } cases[] = {{"1+2*3", 7},
                 {"[1+2]*3", 9},
                 {"2**3**2", 64}, /* from the left */
                 {"-2**2", 4},    /* the sign belongs to the number */
                 {"2*3**2", 18},
                 {"7 MOD 3", 1},
                 {"-7 MOD 3", 2},
                 {"8/2/2", 2},
                 {"2.0 / 3 * 1.5 - 5.5 / 11.0", 0.5}, /* LinuxCNC's example */
                 {"1 EQ 1.0000001", 1},
                 {"1 NE 1.0000001", 0},
                 {"1 GT 2 OR 3 GT 2", 1},
                 {"1 AND 0 OR 1", 1}, /* one level, from the left */
                 {"1 XOR 1", 0},
                 {"2 GE 2 AND 2 LE 2", 1},
                 {"1+1 LT 3", 1},
                 {"SIN[30]", 0.5},
                 {"COS[60]", 0.5},
                 {"TAN[45]", 1},
                 {"ASIN[0.5]", 30},
                 {"ACOS[0.5]", 60},
                 {"ATAN[1]/[-1]", 135},
                 {"SQRT[2]**2", 2},
                 {"ABS[-3]", 3},
                 {"FIX[2.8]", 2},
                 {"FIX[-2.8]", -3},
                 {"FUP[2.8]", 3},
                 {"FUP[-2.8]", -2},
                 {"ROUND[2.5]", 3},
                 {"ROUND[-2.5]", -3},
                 {"LN[EXP[2]]", 2},
                 {"-[3]", -3},
                 {"- SQRT[4]", -2},
                 {"1 + acos[0] - [3 ** [4.0/2]]", 82},
                 {"EXISTS[#<_x>]", 1},
                 {"EXISTS[#<none>]", 0}};
    char line[200];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        snprintf(line, sizeof line, "G0 X[%s]", cases[i].text);
        if (!CHECK_NEAR(run(line), cases[i].value, 1e-12)) fprintf(stderr, "  in: %s\n", line);
    }
    refuse("G0 X[1/0]", "t:1:5: error: '[1/0' divides by zero");
    refuse("G0 X[1", "is not closed");
    refuse("G0 X[1 1 + 2", "is not closed");
    refuse("G0 X[SQRT[-1]]", "has a negative argument");
    refuse("G0 X[LN[0]]", "not positive");
    refuse("G0 X[ASIN[2]]", "beyond -1 .. 1");
    refuse("G0 X[ATAN[1]]", "needs two arguments");
    refuse("G0 X[-1 ** .5]", "power that is not whole");
    refuse("G0 X[10 ** 400]", "beyond what numbers can be");
    refuse("G0 X[FOO[1]]", "'F' is no value");
    refuse("G0 X[EXISTS[1]]", "takes one named parameter");
    char deep[400] = "G0 X";
    for (int i = 0; i < 100; i++) strcat(deep, "[");
    refuse(deep, "nested too deeply");
}

/* Random expressions of whole numbers against C's own arithmetic, with full brackets so that precedence is not asked.
 */
static double grow(test_random *random, int depth, char *text, size_t size)
{
    const size_t used = strlen(text);
    if (depth == 0) {
        const double value = (double)test_random_below(random, 20) - 10;
        snprintf(text + used, size - used, "%g", value);
        return value;
    }
    static const char *const names[] = {"+", "-", "*", "GT", "AND"};
    const int what = (int)test_random_below(random, 5);
    snprintf(text + used, size - used, "[");
    const double a = grow(random, depth - 1, text, size);
    snprintf(text + strlen(text), size - strlen(text), " %s ", names[what]);
    const double b = grow(random, depth - 1, text, size);
    snprintf(text + strlen(text), size - strlen(text), "]");
    return what == 0 ? a + b : what == 1 ? a - b : what == 2 ? a * b : what == 3 ? a > b : a != 0 && b != 0;
}

static void test_random_expressions(void)
{
    test_random random = test_random_begin(5);
    for (int i = 0; i < 500; i++) {
        char text[2000] = "G0 X";
        const double value = grow(&random, 1 + i % 4, text, sizeof text);
        if (fabs(value) <= 1e5) CHECK_NEAR(run(text), value, 1e-9);
    }
}

static void test_parameters(void)
{
    CHECK(run("#3=15\n#3=6 G0 X#3") == 15); /* set when the line has been read */
    CHECK(run("#3=6\nG0 X#3") == 6);
    CHECK(run("#2=3 #3=7\nG0 X##2") == 7);
    CHECK(run("#1=1\n#[#1+4]=9\nG0 X#5") == 9);
    CHECK(run("#<a b>=4\nG0 X#<AB>") == 4); /* blanks and case mean nothing */
    CHECK(run("#<_g>=4\no1 sub\n#<_g>=[#<_g>+1]\no1 endsub\no1 call\nG0 X#<_g>") == 5);
    CHECK(run("G0 X3\nG0 X[#<_x>+#5420+#5021]") == 9);
    CHECK(run("G20 G0 X1\nX[#<_x>+1]") == 50.8);
    CHECK(run("G91 G19 G55 F3 S4 M3 T7\nG90 G0 X[#<_plane>+#<_coord_system>+#<_feed>+#<_rpm>+#<_selected_tool>+"
              "#<_spindle_on>+#<_incremental>]") == 190 + 550 + 3 + 4 + 7 + 1 + 1);
    CHECK(run("G10 L2 P2 Y5\nG0 X#5242") == 5);
    CHECK(run("\n\nG0 X#<_line>") == 3);
    refuse("G0 X#<a>", "has no value yet");
    refuse("o1 sub\nG0 X#<a>\no1 endsub\n#<a>=1\no1 call", "t:2:5: error: '#<a>' is a parameter that has no value");
    refuse("G0 X#9999", "#1 to #5602 are");
    refuse("#5420=1", "the machine's state gives");
    refuse("#<_x>=1", "the machine's state gives");
    refuse("G0 X#<_x>", "not known yet");
    refuse("G0 X#<a", "is not closed");
    refuse("#1.5=2", "is no parameter");
}

static void test_flow(void)
{
    CHECK(run("#1=5 #2=1\no1 while [#1 GT 1]\n#2=[#2*#1] #1=[#1-1]\no1 endwhile\nG0 X#2") == 120);
    CHECK(run("o1 sub\no2 if [#1 LE 1]\n#<_f>=1\no2 else\no1 call [#1-1]\n#<_f>=[#<_f>*#1]\no2 endif\no1 endsub\n"
              "o1 call [5]\nG0 X#<_f>") == 120); /* by recursion: #1 comes back after each call */
    CHECK(run("o1 sub\no2 if [#1 LE 1]\no1 return [1]\no2 endif\n#2=#1\no1 call [#1-1]\no1 endsub [#<_value>*#2]\n"
              "o1 call [6]\nG0 X#<_value>") == 720);
    CHECK(run("#1=0\no1 repeat [4]\n#1=[#1+1]\no2 if [#1 EQ 3]\no1 break\no2 endif\no1 endrepeat\nG0 X#1") == 3);
    CHECK(run("#1=0 #2=0\no1 repeat [4]\n#1=[#1+1]\no2 if [#1 EQ 3]\no1 continue\no2 endif\n#2=[#2+#1]\no1 endrepeat\n"
              "G0 X#2") == 7);
    CHECK(run("#1=0\no1 do\n#1=[#1+1]\no1 while [#1 LT 3]\nG0 X#1") == 3);
    CHECK(run("#1=2\no1 if [#1 EQ 1]\nG0 X1\no1 elseif [#1 EQ 2]\nG0 X2\no1 elseif [1]\nG0 X3\no1 else\nG0 X4\no1 "
              "endif") == 2);
    CHECK(run("#1=0\no1 repeat [3]\no2 repeat [3]\n#1=[#1+1]\no2 endrepeat\no1 endrepeat\nG0 X#1") == 9);
    CHECK(run("#1=0\no1 repeat [2]\no2 while [1]\no3 repeat [5]\n#1=[#1+1]\no2 break\no3 endrepeat\no2 endwhile\n"
              "o1 endrepeat\nG0 X#1") == 2); /* leaving a loop forgets the repeats inside */
    CHECK(run("o<a b> sub\nG0 X#1\no<ab> endsub\no<AB> call [3] (four) [5]") == 3);
    CHECK(run("#5=100\no[#5+1] call [4]\nM2\no101 sub\nG0 X#1\no101 endsub") == 4);
    CHECK(run("G0 X0\nM98 P100 L3\nM2\no100\nG91 G0 X1\nM99") == 3);
    CHECK(run("O5 (title)\nG0 X1\nM30\nG0 X2") == 1);
    CHECK(run("G0 X1\nM99\nX2") == 1);
    refuse("o1 if [1]\nG0 X1", "t:1:1: error: 'o1 if ' begins a block that is not ended");
    refuse("o1 endif", "has no if of its label before it");
    refuse("o1 while [1]\no2 if [1]\no1 endwhile\no2 endif", "the block that is open here is o2 of line 2");
    refuse("o1 sub\no2 sub\no2 endsub\no1 endsub", "begins a subroutine inside another block");
    refuse("o1 sub\no1 endsub\no1 sub\no1 endsub", "exists already");
    refuse("o1 call", "calls a subroutine that is not there");
    refuse("M98 P7", "calls a program that is not there");
    refuse("o1 break", "is in no loop of its label");
    refuse("o1 return", "is in no call");
    refuse("o1 foo", "is no O word");
    refuse("o1 if\no1 endif", "needs a value in brackets");
    refuse("o1 repeat [2] X1\no1 endrepeat", "'X' does not belong into a line of an O word");
    refuse("o1 sub\no1 call\no1 endsub\no1 call", "calls deeper than 10 levels");
    refuse("o1 if [1]\no1 else\no1 else\no1 endif", "after the else");
    refuse("G0 X1 O5", "must be the first word");
    refuse("O1\nG0 X1\nO2\nG0 X2", "runs into another one");
    swarf_gcode_options options = swarf_gcode_options_default();
    options.line_limit = 10000;
    swarf_program *program = NULL;
    const char endless[] = "o1 while [1]\no1 endwhile";
    CHECK_FAILS(swarf_gcode_read(endless, strlen(endless), "t", &options, NULL, &program), SWARF_ERROR_FORMAT,
                "a loop without an end?");
    options = swarf_gcode_options_default();
    CHECK(run_with(&options, "/G0 X1\nG0 X2") == 2);
    options.block_delete = 1;
    CHECK(run_with(&options, "G0 X2\n/G0 X1") == 2);
}

static void write_file(const char *folder, const char *name, const char *text, char *path, size_t size)
{
    snprintf(path, size, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    if (!CHECK(file != NULL)) return;
    fputs(text, file);
    fclose(file);
}

static void test_files(void)
{
    char folder[] = "/tmp/swarf-gcode-XXXXXX", subs[100], main[200], sub[200], table[200], parameters[200];
    if (!CHECK(mkdtemp(folder) != NULL)) return;
    snprintf(subs, sizeof subs, "%s/subs", folder);
    CHECK(mkdir(subs, 0700) == 0);
    write_file(folder, "main.ngc", "o<helper> call [5]\nG0 Y#<_value>\nM2\n", main, sizeof main);
    write_file(subs, "helper.ngc", "o<helper> sub\nG0 X#1\no<helper> endsub [7]\nM2\n", sub, sizeof sub);
    write_file(folder, "t.tbl", "T1 P1 D6.5 Z+10.5 ;mill\n;nothing\nT12 P3 X1 Y2 Q3\n", table, sizeof table);
    write_file(folder, "p.var", "5161\t100\n5162 200\nfoo\n5221 10\n", parameters, sizeof parameters);
    swarf_gcode_options options = swarf_gcode_options_default();
    swarf_program *program = NULL;
    CHECK_FAILS(swarf_gcode_read_file(main, &options, NULL, &program), SWARF_ERROR_FORMAT, "no file 'helper.ngc'");
    options.path = subs;
    CHECK_OK(swarf_gcode_read_file(main, &options, NULL, &program));
    if (CHECK(swarf_program_move_count(program) == 2)) {
        const swarf_move *moves = swarf_program_moves(program);
        CHECK(moves[0].end[0] == 5 && moves[0].line == 2 && moves[1].end[1] == 7 && moves[1].line == 2);
        const swarf_section *section = &swarf_program_sections(program)[swarf_move_get_section(&moves[0])];
        CHECK(strcmp(swarf_program_source_name(program, (size_t)section->source), sub) == 0);
        section = &swarf_program_sections(program)[swarf_move_get_section(&moves[1])];
        CHECK(strcmp(swarf_program_source_name(program, (size_t)section->source), main) == 0);
    }
    swarf_program_release(program);
    swarf_gcode_tool *tools = NULL;
    size_t count = 0;
    CHECK_OK(swarf_gcode_tools_read(table, 1.0, &tools, &count));
    if (CHECK(count == 2)) {
        CHECK(tools[0].number == 1 && tools[0].diameter_mm == 6.5 && tools[0].offset[2] == 10.5);
        CHECK(tools[1].number == 12 && tools[1].offset[0] == 1 && tools[1].orientation == 3);
    }
    swarf_gcode_tools_free(tools);
    write_file(folder, "t.tbl", "P1 D6\n", table, sizeof table);
    CHECK_FAILS(swarf_gcode_tools_read(table, 1.0, &tools, &count), SWARF_ERROR_FORMAT,
                "t.tbl:1:1: error: the row has no T");
    write_file(folder, "t.tbl", "T1\nT1\n", table, sizeof table);
    CHECK_FAILS(swarf_gcode_tools_read(table, 1.0, &tools, &count), SWARF_ERROR_FORMAT, "has a row already");
    /* with parameters machine coordinates are known: G28 goes there, G54's origin is the frame's */
    options = swarf_gcode_options_default();
    options.parameters = parameters;
    CHECK(run_with(&options, "G0 X0 Y0 Z0\nG28") == 90);
    CHECK(run_with(&options, "G0 X0 Y0 Z0\nG53 G0 X0") == -10);
    /* of an inch machine: lengths are, the turn of the work offset (5230) is not */
    write_file(folder, "p.var", "5161 4\n5162 8\n5221 1\n5230 90\n", parameters, sizeof parameters);
    options.parameter_unit_mm = 25.4;
    CHECK_NEAR(run_with(&options, "G0 X0 Y0 Z0\nG53 G0 X0 Y0"), 0, 1e-9);
    CHECK_NEAR(run_with(&options, "G0 X0 Y0 Z0\nG0 X#5161"), 101.6, 1e-9);
    CHECK_NEAR(run_with(&options, "G0 X0 Y0 Z0\nG0 X#5230"), 90, 1e-9);
    options.parameter_unit_mm = 0;
    CHECK_FAILS(swarf_gcode_read("", 0, "t", &options, NULL, &program), SWARF_ERROR_ARGUMENT, "a unit of 0 mm");
    options.parameter_unit_mm = 1;
    write_file(folder, "p.var", "5162 200\n5161 1\n", parameters, sizeof parameters);
    CHECK_FAILS(swarf_gcode_read("", 0, "t", &options, NULL, &program), SWARF_ERROR_FORMAT, "they must ascend");
    const char *const all[] = {main, sub, table, parameters};
    for (size_t i = 0; i < 4; i++) CHECK(unlink(all[i]) == 0);
    CHECK(rmdir(subs) == 0 && rmdir(folder) == 0);
}

static void test_notes(void)
{
    swarf_gcode_options options = swarf_gcode_options_default();
    CHECK_OK(swarf_notes_create(&options.notes));
    const char text[] = "(MSG, hello)\n#1=2.5\n(print,a=#1 b=%d#1 c=%.2f#1 #<none>)\n(foo)\nM110 G28 Z0\nG0 X\n";
    swarf_program *program = NULL;
    CHECK_FAILS(swarf_gcode_read(text, strlen(text), "n", &options, NULL, &program), SWARF_ERROR_FORMAT, "n:6:4:");
    static const struct {
        int kind;
        uint32_t line, column;
        const char *part;
    } wanted[] = {{SWARF_NOTE_MESSAGE, 1, 2, " hello"},
                  {SWARF_NOTE_MESSAGE, 3, 2, "a=2.500000 b=2 c=2.50 ######"},
                  {SWARF_NOTE_WARNING, 5, 1, "'M110' runs a program"},
                  {SWARF_NOTE_WARNING, 5, 6, "not known here"},
                  {SWARF_NOTE_ERROR, 6, 4, "'X' has no number"}};
    if (CHECK(swarf_notes_count(options.notes) == 5))
        for (size_t i = 0; i < 5; i++) {
            const swarf_note note = swarf_notes_get(options.notes, i);
            CHECK(note.kind == wanted[i].kind && note.line == wanted[i].line && note.column == wanted[i].column);
            CHECK(strstr(note.text, wanted[i].part) != NULL && strcmp(note.source, "n") == 0);
        }
    for (int i = 0; i < 20000; i++) CHECK_OK(swarf_notes_add(options.notes, SWARF_NOTE_MESSAGE, "n", 1, 1, "again"));
    CHECK(swarf_notes_count(options.notes) == 3 + 10000); /* the rest is left out */
    swarf_notes_destroy(options.notes);
    refuse("(abort, stop here)", "ends the program");
}

int main(void)
{
    test_expressions();
    test_random_expressions();
    test_parameters();
    test_flow();
    test_files();
    test_notes();
    return test_end();
}
