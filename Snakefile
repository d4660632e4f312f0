# The method on one screen: data set → embedding → generator → novelty and diversity, selection;
# selected and known designs → geometry → repair → mesh → solve → metrics → summary, pictures.
#
#   snakemake --profile profiles/default               everything
#   snakemake --profile profiles/default generative    data set to diversity, with their pictures
#   snakemake --profile profiles/default screening     generated designs by a chamber each, fronts
#   snakemake --profile profiles/default summary       the tables only
#   snakemake --profile profiles/default -n            what would be done, and why

from snakemake.utils import min_version

min_version("9.0")


configfile: "config/config.yaml"


report: "workflow/report/workflow.rst"


wildcard_constraints:
    design="[A-Za-z0-9_-]+",


localrules:
    all,
    diversity_table,
    screened,
    fronts,
    summary_tables,
    report_page,
    run_crate,


include: "workflow/rules/common.smk"  # configuration and designs, checked; input functions
include: "workflow/rules/server.smk"  # a process that has loaded what the stages need
include: "workflow/rules/dataset.smk"  # training designs and their reduced space
include: "workflow/rules/generate.smk"  # new designs, how new they are, which are simulated
include: "workflow/rules/screen.smk"  # generated and training designs by a chamber each
include: "workflow/rules/design.smk"  # one design: geometry, repair, mesh, solve, metrics
include: "workflow/rules/summary.smk"  # all designs: tables of performance and trajectories
include: "workflow/rules/publish.smk"  # pictures and the page


rule all:
    default_target: True
    input:
        rules.summary.input,
        rules.publish.input,
    message:
        "Tables, pictures and page are complete: open results/report/index.html."


onerror:
    sum_up_what_is_there()
