#!/usr/bin/env bash
# Fetches the libraries at the versions of package-lock.json and writes the files that the report embeds.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")"
npm ci --no-audit --no-fund
npx esbuild three.entry.js --bundle --minify --format=iife --global-name=THREE --target=es2020 \
    --legal-comments=none --outfile=three.min.js
cp node_modules/uplot/dist/uPlot.iife.min.js node_modules/uplot/dist/uPlot.min.css .
{
    for library in three uplot; do
        printf '%s %s\n\n' "$library" "$(node -p "require('./node_modules/$library/package.json').version")"
        cat "node_modules/$library/LICENSE"
        printf '\n'
    done
} > LICENSES.txt
rm -rf node_modules
