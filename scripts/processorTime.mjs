import { readdirSync, readFileSync } from 'node:fs'

/** Ticks of Linux's clock of processes in a second. */
const TICKS = 100

/** Processes by their id: parent, start, and processor time so far [s]. */
function listProcesses() {
  const found = new Map()
  for (const name of readdirSync('/proc')) {
    if (!/^\d+$/.test(name)) continue
    try {
      const stat = readFileSync(`/proc/${name}/stat`, 'utf8')
      // Fields after the command's name, which may have spaces: state, parent, …, user and system time, …, start.
      const fields = stat.slice(stat.lastIndexOf(')') + 2).split(' ')
      const seconds = (Number(fields[11]) + Number(fields[12])) / TICKS
      found.set(Number(name), { parent: Number(fields[1]), start: fields[19], seconds })
    } catch {
      // It has ended.
    }
  }
  return found
}

/**
 * Processor time of a process and all that it starts, looked up once a second: of what ends between two looks, the last
 * part is missing.
 *
 * @returns Stops, and answers with the time so far [s]; undefined where it cannot be told: on other systems than Linux.
 */
export function watchProcessorTime(root) {
  if (process.platform !== 'linux') return () => undefined
  const members = new Set([root])
  const seconds = new Map()
  const look = () => {
    const all = listProcesses()
    // Repeats until nothing new is found: an id may be lower than its parent's.
    for (let size = 0; size !== members.size;) {
      size = members.size
      for (const [id, { parent }] of all) if (members.has(parent)) members.add(id)
    }
    for (const id of members) {
      const own = all.get(id)
      if (own !== undefined) seconds.set(`${id} ${own.start}`, own.seconds)
    }
  }
  const timer = setInterval(look, 1000)
  timer.unref()
  return () => {
    clearInterval(timer)
    look()
    return [...seconds.values()].reduce((sum, value) => sum + value, 0)
  }
}
