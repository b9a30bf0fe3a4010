-- wrk: random 32 KB ranges of a file whose size is the first argument after "--".
local size = 0

function init(arguments)
  size = tonumber(arguments[1])
  math.randomseed(7)
end

function request()
  local first = math.random(0, math.max(0, size - 32768))
  return wrk.format("GET", nil, { ["Range"] = "bytes=" .. first .. "-" .. (first + 32767) })
end
